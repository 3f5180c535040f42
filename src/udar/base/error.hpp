#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace udar {

/// Exit codes of the command; the same numbers for ever, since scripts rely on them.
enum class ExitCode : int {
  done = 0,
  internal = 1,
  usage = 2,
  bad_case = 3,
  bad_mesh = 4,
  numerical = 5,
  output = 6,
  resources = 7,
  checkpoint = 8,
  differs = 9,    ///< results are not within the bound that was asked for, or a check of `udar verify` fails
  hung_up = 129,  ///< its terminal was closed
  interrupted = 130,
  terminated = 143,
};

/// One mistake of the user, told with its place, reason and cure.
struct Diagnostic {
  std::string file;     ///< as the user gave it; empty where there is none
  int line = 0;         ///< from 1; 0: no place in a file
  int column = 0;       ///< from 1, in characters
  int length = 1;       ///< characters to underline
  std::string source;   ///< the text of that line
  std::string message;  ///< "unknown key `yeild`"
  std::string pointer;  ///< beside the caret: "this is a length; a velocity is needed"
  std::string cure;     ///< "did you mean `yield_stress`?"
};

/// The diagnostic as the user reads it: message, place, line, caret, cure.
std::string to_text(const Diagnostic& diagnostic);

/// Mistakes of the user in a case, a mesh or on the command line; all that were found, at once.
class UserError : public std::runtime_error {
 public:
  UserError(ExitCode code, std::vector<Diagnostic> found);
  UserError(ExitCode code, const std::string& message, const std::string& cure = "");
  ExitCode code;
  std::vector<Diagnostic> diagnostics;
};

/// In what a computation failed.
struct Culprit {
  enum Kind { unknown, node, element };
  Kind kind = unknown;
  std::uint32_t number = 0;  ///< in Model
};

/// The computation cannot go on: inverted element, not-a-number, unstable step. Says where, when, why and what to do.
class NumericalError : public std::runtime_error {
 public:
  explicit NumericalError(const std::string& text, Culprit in = {}) : std::runtime_error(text), culprit(in) {}

  Culprit culprit;
};

/// A file could not be written or read completely. Nothing that was there before is lost.
class OutputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace udar
