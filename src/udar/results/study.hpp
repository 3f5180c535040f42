#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "udar/results/summary.hpp"

namespace udar {

/// Everything in `study.json`: what `udar converge` and `udar sweep` leave. SI units; a number that does not exist is
/// NaN here and null in the file. The names are for ever: scripts read them.

/// One run of a study and what became of it.
struct StudyRun {
  std::string name;                  ///< of its folder in runs/: "mesh2-step1"
  std::vector<std::string> changes;  ///< of the case, as --set takes them
  std::vector<double> values;        ///< of a sweep: the varied values, NaN for words
  std::vector<std::string> texts;    ///< of a sweep: the same as the user wrote them
  int mesh = 0;                      ///< of a convergence study: which mesh, 0 the coarsest
  int step = 0;                      ///< which time step, 0 the longest
  std::string state;                 ///< done, failed or missing
  std::string reason;                ///< why it is not done
  std::string verdict;               ///< of the run itself: good, doubtful or bad
  long long elements = 0;
  long long steps = 0;
  int threads = 0;
  double stepping_seconds = no_number;
  double shortest_step = no_number;  ///< s
  double longest_step = no_number;   ///< s
  double energy_error = no_number;   ///< part of the energy
  long long shortened_steps = 0;     ///< shorter than the fixed step asked for
};

/// What happens to a number when the mesh is refined, or the time step; docs/convergence-method.md.
struct Estimate {
  std::vector<double> values;       ///< from the coarsest level that was computed to the finest
  std::vector<double> differences;  ///< relative, each level from the next one
  double order = no_number;         ///< observed, from the three finest levels
  double extrapolated = no_number;  ///< Richardson's value for size 0
  double error = no_number;         ///< error bar of the finest value, in its unit
  std::string verdict;              ///< converged, converging, not converging or unknown
  std::string reason;
};

/// A number of summary.json through the study.
struct StudyQuantity {
  std::string name;            ///< where it stands in the summary: "contacts.stop.duration_99"
  std::string unit;            ///< SI; "" for plain numbers
  std::string window;          ///< "0 to 520 us" where its observer looks only then; else ""
  std::vector<double> values;  ///< of every run, in their order
  double value = no_number;    ///< at the finest mesh and step
  Estimate mesh;
  Estimate step;
  std::string verdict;  ///< the worse one of mesh and step
  bool headline = false;
};

/// A history or a field through the study: only differences between levels make sense.
struct StudyDifference {
  std::string name;         ///< "corner.displacement_y", "bodies.plastic_strain"
  std::string unit;         ///< SI
  double time = no_number;  ///< of a field: s
  double size = no_number;  ///< L2 norm of the finest level, in `unit`, as a mean over time or area
  Estimate mesh_l2;         ///< `differences` relative to `size`; `values` are empty, `error` is relative too
  Estimate mesh_max;        ///< the largest difference, relative to the largest value
  Estimate step_l2;
  Estimate step_max;
  std::string verdict;  ///< by the L2 norm
};

/// How the histories were compared.
struct StudyComparison {
  bool aligned = false;       ///< moved so that first touches fall together
  double window = no_number;  ///< s, of the moving average taken before
};

struct Study {
  std::string kind;  ///< converge or sweep
  std::string version;
  std::string case_name;
  int meshes = 0;
  double mesh_ratio = no_number;
  std::vector<double> element_sizes;  ///< m, of the first body, for each mesh
  int steps = 0;
  double tolerance = no_number;     ///< an error bar up to this part of the value is "converged"
  std::vector<std::string> varied;  ///< of a sweep: paths in the case
  StudyComparison comparison;
  std::vector<StudyRun> runs;
  std::vector<StudyQuantity> quantities;
  std::vector<StudyDifference> histories;
  std::vector<StudyDifference> fields;
  std::vector<std::string> warnings;   ///< what may spoil the study, a sentence each
  std::vector<std::string> headlines;  ///< "contact duration of stop = 1.38 ms +- 0.03 ms (mesh) +- 0.002 ms (step)"
};

/// The files of a study folder, by their names in it.
struct StudyFolder {
  static constexpr std::string_view marker = ".udar-study";  ///< says that Udar made this folder, and is its lock
  static constexpr std::string_view runs = "runs";           ///< folder of run folders
  static constexpr std::string_view commands = "runs.txt";   ///< a command line for each run that is not done
  static constexpr std::string_view study = "study.json";
  static constexpr std::string_view table = "study.csv";  ///< every number of every run
  static constexpr std::string_view report = "study.md";
  static constexpr std::string_view page = "study.html";
  static constexpr std::string_view plots = "plots";  ///< folder of SVG
};

std::string to_json(const Study& study);
/// Throws OutputError where `text` is not a study of this schema. Missing and unknown names are passed over.
Study study_from_json(std::string_view text);
/// Reads study.json of a study folder. Throws OutputError.
Study read_study(const std::filesystem::path& folder);

/// Is it a folder that `udar converge` or `udar sweep` made?
bool is_study_folder(const std::filesystem::path& folder);

}  // namespace udar
