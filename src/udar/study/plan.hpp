#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "udar/case/case.hpp"

namespace udar {

/// One run of a study, before it is done.
struct PlannedRun {
  std::string name;                  ///< of its folder
  std::vector<std::string> changes;  ///< of the case, as --set takes them
  std::string resolved;              ///< the case as it will run: what resolved.toml will hold
  std::vector<std::string> texts;    ///< of a sweep: the varied values as the user wrote them
  int mesh = 0;                      ///< 0: the coarsest
  int step = 0;                      ///< 0: the longest
  double elements = 0;               ///< how many, about
  double cost = 0;                   ///< elements x steps, up to a common factor
  double end_time = 0;               ///< s
};

/// The case of a study: its file and what the user changes in all runs.
struct StudyInput {
  std::filesystem::path file;
  std::vector<std::string> assignments;  ///< of --set
};

struct ConvergenceLevels {
  int meshes = 3;
  double ratio = 2;  ///< element size of a mesh over that of the next
  int steps = 3;     ///< each half as long as the one before
};

/// The grid of meshes and steps: run (i, j) has elements of the case's size over ratio^i, in every body, and the step
/// of that mesh over 2^j. A fixed step follows the size of the elements; an automatic one is divided by way of its
/// safety factor. Throws UserError for a case or a level that cannot be.
std::vector<PlannedRun> plan_convergence(const StudyInput& input, const ConvergenceLevels& levels);

/// A value of the case and what it shall be: "obstacles.stop.friction=0,0.1,0.2".
struct Variation {
  std::string path;                 ///< "obstacles.stop.friction"
  std::vector<std::string> values;  ///< as --set takes them
};

/// Reads such a text. Values are parted by commas outside of quotes and brackets; "0:0.5:0.1" stands for 0, 0.1 ...
/// 0.5, a unit may follow ("1:3:1 mm"). Throws UserError.
Variation read_variation(const std::string& text);

/// Every combination of the values; the last variation changes fastest. Throws UserError for a case that cannot be.
std::vector<PlannedRun> plan_sweep(const StudyInput& input, const std::vector<Variation>& variations);

/// Size of the elements of the first body that is not rigid, m, in each mesh; of the first body where all are.
std::vector<double> element_sizes(const StudyInput& input, const ConvergenceLevels& levels);

}  // namespace udar
