#pragma once

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include "run.hpp"
#include "udar/case/case_file.hpp"

namespace udar::verification {

/// A problem's case file, with changes as on the command line: "bodies.bar.mesh.element_size=1 mm".
inline Case load(const std::string& file, const std::vector<std::string>& changes = {}) {
  return load_case(std::string(UDAR_PROBLEM_DIR) + "/" + file, changes);
}

}  // namespace udar::verification
