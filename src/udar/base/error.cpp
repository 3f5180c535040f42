#include "udar/base/error.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <string_view>

#include "udar/base/text.hpp"

namespace udar {
namespace {

/// What brings a caret under the character in `column` of `line`: tabs stay tabs, whatever their width.
std::string blank_before(std::string_view line, int column) {
  std::string blank;
  for (const char c : line) {
    if (static_cast<int>(blank.size()) >= column - 1) break;
    const bool continues = (static_cast<unsigned char>(c) & 0xC0U) == 0x80;  // second byte of a UTF-8 character
    if (!continues) blank += c == '\t' ? '\t' : ' ';
  }
  blank.resize(static_cast<std::size_t>(std::max(column - 1, 0)), ' ');
  return blank;
}

}  // namespace

std::string to_text(const Diagnostic& d) {
  std::string out = fmt::format("error: {}\n", d.message);
  if (d.line > 0) {
    const std::string number = std::to_string(d.line);
    const std::string margin(number.size(), ' ');
    out += fmt::format("{}--> {}:{}:{}\n", margin, d.file, d.line, d.column);
    out += fmt::format("{} | {}\n", number, d.source);
    const std::string indent = blank_before(d.source, d.column);
    const std::string caret(static_cast<std::size_t>(d.length > 0 ? d.length : 1), '^');
    out += fmt::format("{} | {}{}{}{}\n", margin, indent, caret, d.pointer.empty() ? "" : " ", d.pointer);
    if (!d.cure.empty()) out += fmt::format("{} = {}\n", margin, d.cure);
  } else {
    if (!d.file.empty()) out += fmt::format(" --> {}\n", d.file);
    if (!d.pointer.empty()) out += fmt::format("  = {}\n", d.pointer);
    if (!d.cure.empty()) out += fmt::format("  = {}\n", d.cure);
  }
  return out;
}

namespace {

std::string all_texts(const std::vector<Diagnostic>& found) {
  std::string out;
  for (const Diagnostic& d : found) out += to_text(d);
  return out;
}

}  // namespace

UserError::UserError(ExitCode exit_code, std::vector<Diagnostic> found)
    : std::runtime_error(all_texts(found)), code(exit_code), diagnostics(std::move(found)) {}

UserError::UserError(ExitCode exit_code, const std::string& message, const std::string& cure)
    : UserError(exit_code, std::vector<Diagnostic>{{.message = message, .cure = cure}}) {}

}  // namespace udar
