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

/// What a quantity of this SI unit could be in the run, from its masses, energy, size and duration: beside it a
/// momentum or a spin that is only rounding is nothing. 0 for other units, and where nothing is known.
double scale_of_run(const Summary& summary, std::string_view unit);

/// The unit of a column of a history: "corner", "velocity_x" -> "m/s"; "" for plain numbers.
std::string unit_of_quantity(std::string_view history, std::string_view column);

}  // namespace udar
