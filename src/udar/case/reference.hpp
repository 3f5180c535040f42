#pragma once

#include <string>
#include <string_view>

namespace udar {

/// A complete small case file, as the documentation shows it.
std::string_view example_case();

/// docs/case-file.md: every key, its value, default and meaning.
std::string case_file_reference();

/// The keys whose path or meaning contains `filter` (capitals do not matter), for the terminal; all for "".
std::string keys_text(std::string_view filter);

}  // namespace udar
