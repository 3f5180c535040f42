#pragma once

#include <cmath>

namespace udar {

/// A running sum whose rounding error does not grow with the number of terms (Neumaier 1974).
struct CompensatedSum {
  double sum = 0;
  double correction = 0;

  void add(double term) {
    const double total = sum + term;
    correction += std::fabs(sum) >= std::fabs(term) ? (sum - total) + term : (term - total) + sum;
    sum = total;
  }
  [[nodiscard]] double value() const { return sum + correction; }
};

}  // namespace udar
