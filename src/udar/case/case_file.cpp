#include "udar/case/case_file.hpp"

#include <fmt/core.h>

#include "udar/case/ascii.hpp"
#include "udar/case/document.hpp"
#include "udar/case/keys.hpp"
#include "udar/case/rules.hpp"
#include "udar/case/tables.hpp"
#include "udar/results/file.hpp"

namespace udar {
namespace {

[[noreturn]] void refuse(const std::string& name, std::string message, std::string cure) {
  throw UserError(ExitCode::bad_case,
                  std::vector<Diagnostic>{{.file = name, .message = std::move(message), .cure = std::move(cure)}});
}

std::string text_of(const std::filesystem::path& file) {
  const std::string name = printable(file.string());
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(file, error);
  if (status.type() == std::filesystem::file_type::not_found) {
    refuse(name, "there is no such case file", "check the name and the folder");
  }
  if (is_directory(status)) refuse(name, "this is a folder, not a case file", "give the name of a file in it");
  try {
    // One byte more than is allowed shows that a file is too large, also one whose size is not known beforehand.
    return read_beginning(file, largest_document + 1);
  } catch (const OutputError& failure) {
    refuse(name, fmt::format("the case file cannot be read: {}", failure.what()), "check who may read it");
  }
}

/// Everything that needs no file; `document` gives the places.
void check(const Case& c, Mistakes& mistakes, const Document* document, std::vector<Diagnostic>* warnings) {
  check_table(case_schema(), c, "", mistakes);
  check_rules(c, mistakes);
  if (warnings != nullptr) {
    Mistakes doubts;
    find_doubts(c, mistakes, doubts);
    *warnings = doubts.diagnostics(document);
  }
  if (!mistakes.empty()) throw UserError(ExitCode::bad_case, mistakes.diagnostics(document));
}

}  // namespace

Case load_case(const std::filesystem::path& file, std::span<const std::string> assignments,
               std::vector<Diagnostic>* warnings) {
  return read_case(text_of(file), file.string(), assignments, warnings);
}

Case read_case(std::string_view text, std::string_view name, std::span<const std::string> assignments,
               std::vector<Diagnostic>* warnings) {
  auto document = parse_document(text, printable(name));
  if (!document) throw UserError(ExitCode::bad_case, std::vector{document.error()});
  std::vector<Diagnostic> refused;
  for (const std::string& assignment : assignments) {
    if (const auto done = assign(*document, assignment); !done) refused.push_back(done.error());
  }
  if (!refused.empty()) throw UserError(ExitCode::bad_case, refused);

  Case c;
  Mistakes mistakes;
  read_table(case_schema(), document->root, "", c, mistakes);
  check(c, mistakes, &*document, warnings);
  return c;
}

void check_case(const Case& c, std::vector<Diagnostic>* warnings) {
  Mistakes mistakes;
  check(c, mistakes, nullptr, warnings);
}

std::string to_toml(const Case& c) { return write_section(case_schema(), c, "", ""); }

}  // namespace udar
