#pragma once

#include <string>
#include <vector>

#include "udar/results/study.hpp"
#include "udar/study/plan.hpp"
#include "udar/study/run_all.hpp"

namespace udar {

/// The runs of a sweep together. `headlines` as for a convergence study.
Study collect_sweep(const StudyInput& input, const std::vector<Variation>& variations,
                    const std::vector<PlannedRun>& plan, const std::vector<Standing>& standings,
                    const std::vector<std::string>& headlines);

}  // namespace udar
