#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace udar {

/// Where a link of a page leads, given where it led: "" leaves only its words.
using Relink = std::function<std::string(const std::string& target)>;

/// The same text with other targets of its links.
std::string relinked(std::string_view markdown, const Relink& relink);

/// The Markdown of this project's pages as HTML: paragraphs, lists of one level, tables, blocks of code, headings;
/// bold, italic, code and links. What it does not know stays as it was written; no text becomes markup.
std::string html_of(std::string_view markdown, const Relink& relink);

}  // namespace udar
