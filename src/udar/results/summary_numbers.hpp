#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "udar/results/summary.hpp"

namespace udar {

/// A number of a summary that physics makes, not the machine or the program.
struct SummaryNumber {
  std::string name;  ///< where it stands in summary.json: "contacts.stop.duration_99", "momentum.end.y"
  std::string unit;  ///< SI; "" for plain numbers
  double value = no_number;
  double scale = 0;  ///< of its kind, in its unit: beside it rounding errors are nothing. 0: it has none
};

/// All of them, in the order of summary.json; what does not exist is left out.
std::vector<SummaryNumber> numbers_of(const Summary& summary);

/// When anything touched first, s; NaN where nothing did.
double first_touch(const Summary& summary);

/// Counts, flags and errors of the books, which are no results.
bool is_bookkeeping(std::string_view history, std::string_view column);

/// What is up to this part of the scale of its kind is rounding.
inline constexpr double rounding_part = 1e-9;

/// What quantities could be in a run, from its masses, energy, size and duration: beside it a momentum or a spin that
/// is only rounding is nothing.
class RunScales {
 public:
  explicit RunScales(const Summary& summary);
  /// Of quantities in this SI unit; 0 for other units, and where nothing is known.
  [[nodiscard]] double of(std::string_view unit) const;

 private:
  double energy_ = 0;    ///< J
  double momentum_ = 0;  ///< kg m/s
  double velocity_ = 0;  ///< m/s
  double length_ = 0;    ///< m
  double rate_ = 0;      ///< 1/s
};

/// The unit of a column of a history: "corner", "velocity_x" -> "m/s"; "" for plain numbers.
std::string unit_of_quantity(std::string_view history, std::string_view column);

}  // namespace udar
