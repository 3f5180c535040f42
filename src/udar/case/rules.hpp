#pragma once

#include "udar/case/case.hpp"
#include "udar/case/mistakes.hpp"

namespace udar {

/// What must hold between the values of a case; limits of single values belong to their keys.
void check_rules(const Case& c, Mistakes& mistakes);

/// What is possible but hardly meant. Where something is wrong already, nothing is doubted.
void find_doubts(const Case& c, const Mistakes& mistakes, Mistakes& doubts);

}  // namespace udar
