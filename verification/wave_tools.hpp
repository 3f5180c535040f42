#pragma once

#include <doctest/doctest.h>
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "problem.hpp"
#include "tools.hpp"

namespace udar::verification {

// --- the table of a problem

/// Prints one line of the table; true where the relative error keeps the bound.
inline bool within(const std::string& what, double computed, double exact, double bound) {
  const double error = std::fabs(computed - exact) / std::fabs(exact);
  MESSAGE(fmt::format("{}: computed {:.8g}, exact {:.8g}, error {:.3g}, bound {:.3g}", what, computed, exact, error,
                      bound));
  return error <= bound;
}

/// The same for an error that is relative already.
inline bool below(const std::string& what, double error, double bound) {
  MESSAGE(fmt::format("{}: {:.3g}, bound {:.3g}", what, error, bound));
  return error <= bound;
}

/// Order of convergence from the last two of errors on meshes that halve; prints all of them.
inline double order_of(const std::string& what, const std::vector<double>& errors) {
  std::string line = what + ":";
  for (std::size_t i = 0; i < errors.size(); ++i) {
    line += fmt::format(" {:.4g}", errors[i]);
    if (i > 0) line += fmt::format(" (order {:.2f})", std::log2(errors[i - 1] / errors[i]));
  }
  MESSAGE(line);
  return std::log2(errors[errors.size() - 2] / errors.back());
}

}  // namespace udar::verification
