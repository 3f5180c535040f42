#pragma once

#include <limits>
#include <string>
#include <vector>

namespace udar {

/// How a check is judged. The text of a table says the same in words.
enum class CheckKind {
  relative,  ///< |computed - exact| <= bound |exact|
  absolute,  ///< |computed - exact| <= bound
  equal,     ///< computed == exact
  at_most,   ///< computed <= bound
  below,     ///< computed < bound
  at_least,  ///< computed >= bound
  above,     ///< computed > bound
  between,   ///< bound <= computed <= upper
  order,     ///< an order of convergence, between bound and upper; `exact` is the one expected
  holds,     ///< true
};

/// One check of a problem: a number against its exact value or a bound, or words that hold. No number counts as none
/// that holds.
struct CheckRow {
  CheckKind kind = CheckKind::holds;
  std::string setting;  ///< with which mesh or step: "50 cells"; empty: the only one
  std::string what;     ///< "contact", "mirror symmetry"
  std::string unit;     ///< SI, of all numbers but a relative error and its bound; "" for plain numbers
  double computed = std::numeric_limits<double>::quiet_NaN();
  double exact = std::numeric_limits<double>::quiet_NaN();  ///< NaN: there is none
  double error = std::numeric_limits<double>::quiet_NaN();  ///< NaN: the number is compared with a bound as it is
  double bound = std::numeric_limits<double>::quiet_NaN();
  double upper = std::numeric_limits<double>::quiet_NaN();  ///< of `between` and `order`; infinite: none
  bool holds = false;
};

/// Errors on several meshes, or with several steps, and the order in which they fall.
struct ErrorSeries {
  std::string what;                                            ///< "stress, L2 error"
  std::string size = "element size";                           ///< what the errors depend on
  std::string size_unit = "m";                                 ///< SI
  std::vector<double> sizes{};                                 ///< falling
  std::vector<double> errors{};                                ///< as many
  std::vector<double> bounds{};                                ///< as many, or none
  double order = std::numeric_limits<double>::quiet_NaN();     ///< measured
  double expected = std::numeric_limits<double>::quiet_NaN();  ///< NaN: not known

  void add(double mesh_or_step, double error) {
    sizes.push_back(mesh_or_step);
    errors.push_back(error);
  }
  /// With the bound of the error: all of them have one, or none.
  void add(double mesh_or_step, double error, double bound) {
    add(mesh_or_step, error);
    bounds.push_back(bound);
  }
};

/// A line of a curve.
struct CheckLine {
  std::string name;  ///< "800 cells", "exact"
  bool exact = false;
  std::vector<double> x;  ///< rising
  std::vector<double> y;  ///< as many
};

/// Something computed drawn beside what is exact.
struct CheckCurve {
  std::string title;
  std::string x_label = "time";
  std::string x_unit = "s";  ///< SI
  std::string y_label;
  std::string y_unit;  ///< SI; "" for plain numbers
  std::vector<CheckLine> lines{};
};

/// A part of a problem as it came out.
struct VerifiedPart {
  std::string name;
  bool is_long = false;
  double seconds = 0;
  std::vector<CheckRow> rows{};
  std::vector<ErrorSeries> series{};
  std::vector<CheckCurve> curves{};
  std::vector<std::string> notes{};
  std::vector<std::string> page_rows{};  ///< "| name | cells |", for the tables of a shipped case's own page
};

/// A problem as it came out.
struct VerifiedProblem {
  std::string id;
  std::string title;
  std::string topic;
  std::string text;  ///< its page, Markdown, without the title
  std::vector<VerifiedPart> parts{};
};

/// What `udar verify` found.
struct Verification {
  std::string version;    ///< of the program, with its compiler
  std::string processor;  ///< name of the model
  std::string date;       ///< of the start, UTC: 2026-01-31 12:00
  double seconds = 0;     ///< from start to end
  int cores = 0;
  bool with_long = false;
  double bounds = 1;  ///< by what the bounds of errors were multiplied
  std::vector<VerifiedProblem> problems{};
};

/// Whether the numbers of a row hold; of words, what was said. A number that is not finite never does.
bool is_held(const CheckRow& row);

/// Multiplies the bounds of errors (upper ones: `relative`, `absolute`, `at_most`, `below`) and judges again.
void scale_bounds(VerifiedProblem& problem, double factor);

/// Checks and how many of them hold. A long part that begins with the settings of a quick one repeats its numbers: what
/// another part of the problem has to the same bits counts once.
struct CheckCount {
  std::size_t held = 0;
  std::size_t all = 0;
};
CheckCount count_of(const VerifiedProblem& problem);
CheckCount count_of(const Verification& verification);
/// The rows of a part with the same name together, in the order of their first.
std::vector<std::vector<const CheckRow*>> grouped(const VerifiedPart& part);
/// Sum over the parts, s.
double seconds_of(const VerifiedProblem& problem);

/// The cells of a row in words: "0.0396", "≤ 5 %", "holds". Empty where there is nothing to say.
struct CheckWords {
  std::string computed;
  std::string exact;
  std::string error;
  std::string bound;
  std::string verdict;  ///< "holds" or "FAILS"
};
CheckWords words_of(const CheckRow& row);

/// Everything but the texts, as JSON (docs/results.md).
std::string to_json(const Verification& verification);

}  // namespace udar
