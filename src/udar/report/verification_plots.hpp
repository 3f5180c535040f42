#pragma once

#include <string>
#include <vector>

#include "udar/results/verification.hpp"

namespace udar {

/// A picture of the manual of verification.
struct VerificationPlot {
  std::string caption;  ///< what it shows, for those who do not see it
  std::string svg;
};

/// The pictures of a part: errors over the mesh or the step with their bounds and the order measured, on logarithmic
/// axes; then what was computed beside what is exact.
std::vector<VerificationPlot> verification_plots(const VerifiedPart& part);

}  // namespace udar
