#include "udar/report/study_runs.hpp"

#include <algorithm>
#include <map>

#include "udar/base/human_unit.hpp"

namespace udar {
namespace {

namespace fs = std::filesystem;

/// What says best what a path in the case is: "friction" of "obstacles.stop.friction", "velocity.0" of
/// "bodies.ball.velocity.0".
std::string last_part(const std::string& path) {
  const std::size_t dot = path.rfind('.');
  if (dot == std::string::npos) return path;
  const bool is_number = path.find_first_not_of("0123456789", dot + 1) == std::string::npos && dot + 1 < path.size();
  if (!is_number || dot == 0) return path.substr(dot + 1);
  return path.substr(path.rfind('.', dot - 1) + 1);
}

bool is_done(const StudyRun& run) { return run.state == "done"; }

}  // namespace

fs::path study_run_folder(const fs::path& study, const StudyRun& run) {
  const bool is_name = !run.name.empty() && run.name != "." && run.name != ".." &&
                       run.name.find('/') == std::string::npos && run.name.find('\0') == std::string::npos;
  return is_name ? study / StudyFolder::runs / run.name : fs::path();
}

std::vector<std::size_t> mesh_levels(const Study& study) {
  std::map<int, std::size_t> finest;  // by mesh
  for (std::size_t r = 0; r < study.runs.size(); ++r) {
    const StudyRun& run = study.runs[r];
    if (!is_done(run)) continue;
    const auto [at, is_new] = finest.emplace(run.mesh, r);
    if (!is_new && run.step > study.runs[at->second].step) at->second = r;
  }
  std::vector<std::size_t> levels;
  for (const auto& [mesh, r] : finest) levels.push_back(r);
  return levels;
}

std::vector<std::size_t> step_levels(const Study& study) {
  const std::vector<std::size_t> meshes = mesh_levels(study);
  std::vector<std::size_t> levels;
  if (meshes.empty()) return levels;
  for (std::size_t r = 0; r < study.runs.size(); ++r) {
    if (is_done(study.runs[r]) && study.runs[r].mesh == study.runs[meshes.back()].mesh) levels.push_back(r);
  }
  std::stable_sort(levels.begin(), levels.end(),
                   [&](std::size_t a, std::size_t b) { return study.runs[a].step < study.runs[b].step; });
  return levels;
}

std::vector<std::size_t> done_runs(const Study& study) {
  std::vector<std::size_t> done;
  for (std::size_t r = 0; r < study.runs.size(); ++r) {
    if (is_done(study.runs[r])) done.push_back(r);
  }
  return done;
}

std::vector<std::size_t> shown_runs(const Study& study, std::size_t most) {
  if (study.kind == "converge") {
    std::vector<std::size_t> levels = mesh_levels(study);
    if (levels.size() == 1) levels = step_levels(study);
    if (levels.size() > most) levels.erase(levels.begin(), levels.end() - static_cast<std::ptrdiff_t>(most));
    return levels;
  }
  std::vector<std::size_t> done = done_runs(study);
  if (done.size() <= most || most < 2) {
    done.resize(std::min(done.size(), most));
    return done;
  }
  std::vector<std::size_t> chosen;
  for (std::size_t k = 0; k < most; ++k) {
    chosen.push_back(done[(k * (done.size() - 1) + (most - 1) / 2) / (most - 1)]);
  }
  return chosen;
}

std::string level_label(const Study& study, const StudyRun& run) {
  if (study.kind == "converge") {
    const auto mesh = static_cast<std::size_t>(run.mesh);
    if (run.mesh >= 0 && mesh < study.element_sizes.size() && study.element_sizes[mesh] > 0) {
      return human_text(study.element_sizes[mesh], "m", 4);
    }
    return run.name;
  }
  std::string label;
  for (std::size_t v = 0; v < run.texts.size(); ++v) {
    const std::string name = v < study.varied.size() ? last_part(study.varied[v]) : "";
    label += (label.empty() ? "" : ", ") + name + (name.empty() ? "" : " ") + run.texts[v];
  }
  return label.empty() ? run.name : label;
}

}  // namespace udar
