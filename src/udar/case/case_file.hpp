#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "udar/base/error.hpp"
#include "udar/case/case.hpp"

namespace udar {

/// Reads a case file (docs/case-file.md). Each of `assignments`, "bodies.beam.thickness=2 cm", then replaces a value.
/// Throws UserError(bad_case) with everything that is wrong, in the order of the file. What is possible but hardly
/// meant goes to `warnings` if given.
Case load_case(const std::filesystem::path& file, std::span<const std::string> assignments = {},
               std::vector<Diagnostic>* warnings = nullptr);

/// The same from a text; `name` is what messages call it.
Case read_case(std::string_view text, std::string_view name, std::span<const std::string> assignments = {},
               std::vector<Diagnostic>* warnings = nullptr);

/// The same checks for a case built in code: throws UserError(bad_case), with the path of each value instead of a
/// place.
void check_case(const Case& c, std::vector<Diagnostic>* warnings = nullptr);

/// The case as a case file: everything in SI units, defaults included. Reads back to the same case, bit for bit.
std::string to_toml(const Case& c);

}  // namespace udar
