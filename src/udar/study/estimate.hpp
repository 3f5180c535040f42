#pragma once

#include <span>
#include <string>
#include <string_view>

#include "udar/results/study.hpp"

namespace udar {

/// What is asked of a number so that it counts as converged.
struct Standard {
  double tolerance = 0.02;  ///< an error bar up to this part of the value
  double zero = 0;          ///< a number whose size is up to this in all levels is zero to rounding
};

/// What refinement does to a number, after Roache (1994), Celik et al. (2008) and Eca and Hoekstra (2014); the rules
/// are in docs/convergence-method.md. `values` and `sizes` (of elements or steps, any unit) are from the coarsest level
/// to the finest one; values that are NaN were not computed.
///
/// - order: p with f(h) = f_0 + C h^p through the three finest values;
/// - extrapolated: f_0;
/// - error: the grid convergence index as a length on the axis of the values.
Estimate estimate_limit(std::span<const double> values, std::span<const double> sizes, const Standard& standard);

/// The same for histories and fields, of which only the differences between each level and the next finer one are
/// numbers: relative norms. The error bar is relative, too.
Estimate estimate_norms(std::span<const double> differences, std::span<const double> sizes, const Standard& standard);

namespace verdict {
constexpr std::string_view converged = "converged";
constexpr std::string_view converging = "converging";
constexpr std::string_view not_converging = "not converging";
constexpr std::string_view unknown = "unknown";
}  // namespace verdict

/// The worse one of two verdicts; "" (nothing was refined) is better than any.
std::string worse(const std::string& a, const std::string& b);

}  // namespace udar
