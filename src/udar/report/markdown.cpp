#include "udar/report/markdown.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <vector>

#include "udar/results/xml.hpp"

namespace udar {
namespace {

/// A link "[words](target)" that begins at `at`; false where there is none.
struct Link {
  std::string_view words;
  std::string_view target;
  std::size_t end = 0;
};
bool find_link(std::string_view text, std::size_t at, Link& link) {
  if (text[at] != '[') return false;
  const std::size_t middle = text.find(']', at);
  if (middle == text.npos || middle + 1 >= text.size() || text[middle + 1] != '(') return false;
  const std::size_t end = text.find(')', middle);
  if (end == text.npos) return false;
  link = {text.substr(at + 1, middle - at - 1), text.substr(middle + 2, end - middle - 2), end + 1};
  return true;
}

/// What stands between two marks of a kind, the first at `at`; false where there is no second.
bool between(std::string_view text, std::size_t at, std::string_view mark, std::string_view& inside) {
  if (!text.substr(at).starts_with(mark)) return false;
  const std::size_t begin = at + mark.size();
  const std::size_t end = text.find(mark, begin);
  if (end == text.npos || end == begin || text[begin] == ' ') return false;
  inside = text.substr(begin, end - begin);
  return true;
}

std::string inline_html(std::string_view text, const Relink& relink) {
  std::string out;
  std::size_t plain = 0;
  const auto flush = [&](std::size_t end) { out += escape_xml(text.substr(plain, end - plain)); };
  for (std::size_t at = 0; at < text.size();) {
    std::string_view inside;
    Link link;
    if (between(text, at, "`", inside)) {
      flush(at);
      out += "<code>" + escape_xml(inside) + "</code>";
      at = plain = at + inside.size() + 2;
    } else if (between(text, at, "**", inside)) {
      flush(at);
      out += "<strong>" + inline_html(inside, relink) + "</strong>";
      at = plain = at + inside.size() + 4;
    } else if (between(text, at, "*", inside)) {
      flush(at);
      out += "<em>" + inline_html(inside, relink) + "</em>";
      at = plain = at + inside.size() + 2;
    } else if (find_link(text, at, link)) {
      flush(at);
      const std::string target = relink(std::string(link.target));
      const std::string words = inline_html(link.words, relink);
      out += target.empty() ? words : fmt::format(R"(<a href="{}">{}</a>)", escape_xml(target), words);
      at = plain = link.end;
    } else {
      ++at;
    }
  }
  flush(text.size());
  return out;
}

std::vector<std::string_view> lines_of(std::string_view text) {
  std::vector<std::string_view> lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    lines.push_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

std::vector<std::string> cells_of(std::string_view row) {
  std::vector<std::string> cells;
  row.remove_prefix(1);
  for (std::size_t end = 0; (end = row.find('|')) != row.npos; row.remove_prefix(end + 1)) {
    cells.emplace_back(row.substr(0, end));
  }
  return cells;
}

/// Lines gathered into one block at a time.
class Blocks {
 public:
  explicit Blocks(const Relink& relink) : relink_(relink) {}

  void add(std::string_view line) {
    if (kind_ == Kind::code) {
      if (line.starts_with("```")) return close();
      body_ += escape_xml(line) + "\n";
    } else if (line.starts_with("```")) {
      open(Kind::code);
    } else if (line.find_first_not_of(' ') == line.npos) {
      close();
    } else if (line.starts_with("#")) {
      close();
      out_ += fmt::format("<h5>{}</h5>\n",
                          inline_html(line.substr(std::min(line.find_first_not_of("# "), line.size())), relink_));
    } else if (line.starts_with("|")) {
      if (kind_ != Kind::table) open(Kind::table);
      rows_.emplace_back(line);
    } else if (line.starts_with("- ")) {
      if (kind_ != Kind::list) open(Kind::list);
      items_.emplace_back(line.substr(2));
    } else if (kind_ == Kind::list) {
      items_.back() += " " + std::string(line);
    } else {
      if (kind_ != Kind::paragraph) open(Kind::paragraph);
      body_ += (body_.empty() ? "" : " ") + std::string(line);
    }
  }
  std::string finish() {
    close();
    return out_;
  }

 private:
  enum class Kind { none, paragraph, list, table, code };

  void open(Kind kind) {
    close();
    kind_ = kind;
  }
  void close() {
    if (kind_ == Kind::paragraph) out_ += "<p>" + inline_html(body_, relink_) + "</p>\n";
    if (kind_ == Kind::code) out_ += "<pre>" + body_ + "</pre>\n";
    if (kind_ == Kind::list) {
      out_ += "<ul>\n";
      for (const std::string& item : items_) out_ += "<li>" + inline_html(item, relink_) + "</li>\n";
      out_ += "</ul>\n";
    }
    if (kind_ == Kind::table) close_table();
    kind_ = Kind::none;
    body_.clear();
    items_.clear();
    rows_.clear();
  }
  void close_table() {
    out_ += "<table>\n";
    for (std::size_t r = 0; r < rows_.size(); ++r) {
      if (rows_[r].find_first_not_of("|-: ") == std::string::npos) continue;
      const char* tag = r == 0 ? "th" : "td";
      out_ += "<tr>";
      for (const std::string& cell : cells_of(rows_[r]))
        out_ += fmt::format("<{0}>{1}</{0}>", tag, inline_html(cell, relink_));
      out_ += "</tr>\n";
    }
    out_ += "</table>\n";
  }

  const Relink& relink_;
  std::string out_;
  Kind kind_ = Kind::none;
  std::string body_;
  std::vector<std::string> items_;
  std::vector<std::string> rows_;
};

}  // namespace

std::string relinked(std::string_view markdown, const Relink& relink) {
  std::string out;
  for (std::size_t at = 0; at < markdown.size();) {
    Link link;
    if (find_link(markdown, at, link)) {
      const std::string target = relink(std::string(link.target));
      out += target.empty() ? std::string(link.words) : fmt::format("[{}]({})", link.words, target);
      at = link.end;
    } else {
      out += markdown[at++];
    }
  }
  return out;
}

std::string html_of(std::string_view markdown, const Relink& relink) {
  Blocks blocks(relink);
  for (const std::string_view line : lines_of(markdown)) blocks.add(line);
  return blocks.finish();
}

}  // namespace udar
