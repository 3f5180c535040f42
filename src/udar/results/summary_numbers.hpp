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

/// Counts, flags and errors of the books, which are no results.
bool is_bookkeeping(std::string_view history, std::string_view column);

/// The largest distance of a body from the origin, m: with a momentum, the scale of a spin. 0 where nothing is known.
double length_scale(const Summary& summary);

/// The unit of a column of a history: "corner", "velocity_x" -> "m/s"; "" for plain numbers.
std::string unit_of_quantity(std::string_view history, std::string_view column);

}  // namespace udar
