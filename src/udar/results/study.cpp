#include "udar/results/study.hpp"

#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "udar/base/error.hpp"
#include "udar/results/file.hpp"
#include "udar/results/json_members.hpp"

namespace udar {

constexpr int study_schema = 1;

template <Is<StudyRun> T, class Visit>
void for_each_member(T& r, Visit visit) {
  visit("name", r.name);
  visit("changes", r.changes);
  visit("values", r.values);
  visit("texts", r.texts);
  visit("mesh", r.mesh);
  visit("step", r.step);
  visit("state", r.state);
  visit("reason", r.reason);
  visit("verdict", r.verdict);
  visit("elements", r.elements);
  visit("steps", r.steps);
  visit("threads", r.threads);
  visit("stepping_seconds", r.stepping_seconds);
  visit("shortest_step", r.shortest_step);
  visit("longest_step", r.longest_step);
  visit("energy_error", r.energy_error);
  visit("shortened_steps", r.shortened_steps);
}

template <Is<Estimate> T, class Visit>
void for_each_member(T& e, Visit visit) {
  visit("values", e.values);
  visit("differences", e.differences);
  visit("order", e.order);
  visit("extrapolated", e.extrapolated);
  visit("error", e.error);
  visit("verdict", e.verdict);
  visit("reason", e.reason);
}

template <Is<StudyQuantity> T, class Visit>
void for_each_member(T& q, Visit visit) {
  visit("name", q.name);
  visit("unit", q.unit);
  visit("window", q.window);
  visit("values", q.values);
  visit("value", q.value);
  visit("mesh", q.mesh);
  visit("step", q.step);
  visit("verdict", q.verdict);
  visit("headline", q.headline);
}

template <Is<StudyDifference> T, class Visit>
void for_each_member(T& d, Visit visit) {
  visit("name", d.name);
  visit("unit", d.unit);
  visit("time", d.time);
  visit("size", d.size);
  visit("mesh_l2", d.mesh_l2);
  visit("mesh_max", d.mesh_max);
  visit("step_l2", d.step_l2);
  visit("step_max", d.step_max);
  visit("verdict", d.verdict);
}

template <Is<StudyComparison> T, class Visit>
void for_each_member(T& c, Visit visit) {
  visit("aligned", c.aligned);
  visit("window", c.window);
}

template <Is<Study> T, class Visit>
void for_each_member(T& s, Visit visit) {
  visit("kind", s.kind);
  visit("version", s.version);
  visit("case_name", s.case_name);
  visit("meshes", s.meshes);
  visit("mesh_ratio", s.mesh_ratio);
  visit("element_sizes", s.element_sizes);
  visit("steps", s.steps);
  visit("tolerance", s.tolerance);
  visit("varied", s.varied);
  visit("comparison", s.comparison);
  visit("runs", s.runs);
  visit("quantities", s.quantities);
  visit("histories", s.histories);
  visit("fields", s.fields);
  visit("warnings", s.warnings);
  visit("headlines", s.headlines);
}

std::string to_json(const Study& study) {
  Json out{{"schema", study_schema}};
  out.update(json_of(study));
  return out.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

Study study_from_json(std::string_view text) {
  try {
    const Json json = Json::parse(text);
    if (json.at("schema") != study_schema)
      throw OutputError(fmt::format("the study is not of schema {}", study_schema));
    Study study;
    read_json(json, study);
    return study;
  } catch (const Json::exception& error) {
    throw OutputError(fmt::format("not a study: {}", error.what()));
  }
}

Study read_study(const std::filesystem::path& folder) {
  constexpr std::size_t most_bytes = std::size_t{1} << 28;
  const std::filesystem::path path = folder / StudyFolder::study;
  const std::string text = read_file(path, most_bytes);
  try {
    return study_from_json(text);
  } catch (const OutputError& error) {
    throw OutputError(fmt::format("cannot read {}: {}", path.string(), error.what()));
  }
}

bool is_study_folder(const std::filesystem::path& folder) {
  std::error_code error;
  return std::filesystem::is_regular_file(folder / StudyFolder::marker, error);
}

}  // namespace udar
