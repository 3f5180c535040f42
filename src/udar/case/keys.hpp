#pragma once

#include "udar/case/case.hpp"
#include "udar/case/schema.hpp"

namespace udar {

/// Every key of a case file. Material laws, obstacle shapes and mesh generators bring their own.
const Schema<Case>& case_schema();

}  // namespace udar
