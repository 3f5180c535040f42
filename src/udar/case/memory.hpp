#pragma once

#include "udar/case/case.hpp"

namespace udar {

/// How many elements the meshes of a case will have, about. Of a graded mesh rather too few are counted: it is looked
/// at again while it is refined.
double elements_about(const Case& c);

/// Bytes that a run of the case takes at least, about: what is kept for each element, and of each obstacle for each
/// outer node.
double memory_about(const Case& c);

/// Throws UserError(resources) where that is more than there is, before any of it is taken.
void check_memory(const Case& c);

}  // namespace udar
