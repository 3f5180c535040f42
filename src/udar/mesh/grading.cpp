#include "udar/mesh/grading.hpp"

#include <fmt/core.h>

#include <cmath>

#include "udar/base/error.hpp"
#include "udar/base/text.hpp"
#include "udar/units/quantity.hpp"

namespace udar {
namespace {

/// Finer than this part of the element size is a mistake of units, and near the rounding of places.
constexpr double finest_part = 1e-6;
constexpr double rounding = 1 + 1e-9;

std::string length_text(double metres) { return si_text(metres, dimension::length); }

std::optional<GradingFault> size_fault(double size, double element_size) {
  if (!(std::isfinite(size) && size > 0)) {
    return GradingFault{"finest_size", "the finest size must be above 0", "", "leave it out for elements of one size"};
  }
  if (size > element_size * rounding) {
    return GradingFault{"finest_size", "the finest elements are larger than the others",
                        fmt::format("element_size is {}", length_text(element_size)),
                        fmt::format("write \"{}\" or less", length_text(element_size))};
  }
  if (size < finest_part * element_size) {
    return GradingFault{"finest_size", "the finest elements are far too small",
                        fmt::format("{} against element_size = {}", length_text(size), length_text(element_size)),
                        "choose larger ones, or check the units"};
  }
  return {};
}

}  // namespace

std::optional<GradingFault> grading_fault(const Grading& grading, const GradedShape& shape) {
  const bool somewhere = grading.at.has_value() || !grading.side.empty();
  if (!grading.size) {
    if (!somewhere) return {};
    return GradingFault{grading.at ? "finest_at" : "finest_side", "how fine is not said", "finest_size is missing",
                        fmt::format("add finest_size = \"{}\"", length_text(shape.element_size / 4))};
  }
  if (auto fault = size_fault(*grading.size, shape.element_size)) return fault;
  if (!somewhere) {
    return GradingFault{"finest_size", "where elements are finest is not said",
                        "one of finest_at and finest_side is needed",
                        fmt::format("add finest_side = \"{}\"", shape.sides.front())};
  }
  if (grading.at && !grading.side.empty()) {
    return GradingFault{"finest_at", "finest in two places", "finest_side is given as well", "leave one of them out"};
  }
  if (!grading.side.empty() && std::ranges::find(shape.sides, grading.side) == shape.sides.end()) {
    return GradingFault{"finest_side", fmt::format("there is no side \"{}\"", grading.side), "",
                        fmt::format("there is {}", one_of(shape.sides))};
  }
  // A point of the boundary may come out a little beyond it by rounding.
  if (grading.at && !(shape.outside <= finest_part * shape.element_size)) {
    return GradingFault{"finest_at", "the finest place lies outside the body",
                        fmt::format("by {}", length_text(shape.outside)),
                        "give a point of the body, where it is placed"};
  }
  if (!(std::isfinite(grading.within) && grading.within >= 0)) {
    return GradingFault{"finest_within", "the distance must be a number of at least 0", "", "leave it out"};
  }
  if (!(grading.growth > 1 && grading.growth <= 2)) {
    return GradingFault{"growth", "elements must grow by a factor above 1 and at most 2", "", "leave it out for 1.2"};
  }
  return {};
}

void throw_fault(const GradingFault& fault) {
  const std::string why = fault.reason.empty() ? "" : ": " + fault.reason;
  throw UserError(ExitCode::bad_mesh, fault.message + why, fault.cure);
}

double coarse_size(const Grading& grading, double element_size) {
  if (!grading.size || !std::isfinite(element_size)) return element_size;
  double size = *grading.size;
  while (2 * size <= element_size * rounding) size *= 2;
  return size;
}

}  // namespace udar
