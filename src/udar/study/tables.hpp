#pragma once

#include <string>

#include "udar/results/study.hpp"

namespace udar {

/// study.csv, SI units. Of a convergence study a row for each number: its value in every run, then what refinement
/// says; of a sweep a row for each run: what was varied, then every number.
std::string to_csv(const Study& study);

/// study.md: the study for people, in tables.
std::string to_markdown(const Study& study);

}  // namespace udar
