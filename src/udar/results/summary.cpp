#include "udar/results/summary.hpp"

#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "udar/base/error.hpp"
#include "udar/results/file.hpp"
#include "udar/results/json_members.hpp"

namespace udar {

constexpr int summary_schema = 1;

template <Is<HistorySummary> T, class Visit>
void for_each_member(T& s, Visit visit) {
  visit("min", s.min);
  visit("max", s.max);
  visit("max_abs", s.max_abs);
  visit("last", s.last);
  visit("time_of_min", s.time_of_min);
  visit("time_of_max", s.time_of_max);
}

template <Is<EpisodeSummary> T, class Visit>
void for_each_member(T& s, Visit visit) {
  visit("first_touch", s.first_touch);
  visit("separation", s.separation);
  visit("duration", s.duration);
  visit("impulse", s.impulse);
  visit("peak_force", s.peak_force);
  visit("velocity_before", s.velocity_before);
  visit("velocity_after", s.velocity_after);
  visit("restitution", s.restitution);
  visit("tangential_restitution", s.tangential_restitution);
  visit("slip_velocity_before", s.slip_velocity_before);
  visit("slip_velocity_after", s.slip_velocity_after);
  visit("spin_before", s.spin_before);
  visit("spin_after", s.spin_after);
}

template <Is<ContactSummary> T, class Visit>
void for_each_member(T& s, Visit visit) {
  visit("first_touch", s.first_touch);
  visit("last_separation", s.last_separation);
  visit("duration", s.duration);
  visit("duration_99", s.duration_99);
  visit("impulse", s.impulse);
  visit("peak_force", s.peak_force);
  visit("merged_gaps", s.merged_gaps);
  visit("episodes", s.episodes);
}

template <Is<LedgerSummary> T, class Visit>
void for_each_member(T& s, Visit visit) {
  visit("start", s.start);
  visit("kinetic", s.kinetic);
  visit("elastic", s.elastic);
  visit("plastic", s.plastic);
  visit("stored_elastic", s.stored_elastic);
  visit("contact", s.contact);
  visit("ties", s.ties);
  visit("friction", s.friction);
  visit("dropped", s.dropped);
  visit("damping", s.damping);
  visit("gravity", s.gravity);
  visit("loads", s.loads);
  visit("supports", s.supports);
  visit("obstacles", s.obstacles);
  visit("total", s.total);
  visit("error", s.error);
}

/// Of momentum and of spin.
template <class T, class Visit>
requires(Is<T, MomentumSummary> || Is<T, SpinSummary>) void for_each_member(T& s, Visit visit) {
  visit("start", s.start);
  visit("end", s.end);
  visit("obstacles", s.obstacles);
  visit("gravity", s.gravity);
  visit("loads", s.loads);
  visit("supports", s.supports);
  visit("damping", s.damping);
  visit("error", s.error);
}

template <Is<PenetrationSummary> T, class Visit>
void for_each_member(T& s, Visit visit) {
  visit("depth", s.depth);
  visit("time", s.time);
  visit("place", s.place);
  visit("body", s.body);
  visit("into", s.into);
  visit("stiffness", s.stiffness);
}

template <Is<TimeStepSummary> T, class Visit>
void for_each_member(T& s, Visit visit) {
  visit("min", s.min);
  visit("max", s.max);
  visit("time_of_min", s.time_of_min);
  visit("limited_by", s.limited_by);
  visit("shortened_steps", s.shortened_steps);
  visit("first_shortened", s.first_shortened);
  visit("first_shortened_by", s.first_shortened_by);
}

template <Is<BodySummary> T, class Visit>
void for_each_member(T& s, Visit visit) {
  visit("name", s.name);
  visit("rigid", s.rigid);
  visit("elements", s.elements);
  visit("nodes", s.nodes);
}

template <Is<ObservedSummary> T, class Visit>
void for_each_member(T& s, Visit visit) {
  visit("on", s.on);
  visit("body", s.body);
  visit("number", s.number);
}

template <Is<MachineSummary> T, class Visit>
void for_each_member(T& s, Visit visit) {
  visit("processor", s.processor);
  visit("threads", s.threads);
}

template <Is<Summary> T, class Visit>
void for_each_member(T& s, Visit visit) {
  visit("version", s.version);
  visit("case_name", s.case_name);
  visit("started", s.started);
  visit("machine", s.machine);
  visit("elements", s.elements);
  visit("nodes", s.nodes);
  visit("steps", s.steps);
  visit("threads", s.threads);
  visit("resumed", s.resumed);
  visit("wall_seconds", s.wall_seconds);
  visit("stepping_seconds", s.stepping_seconds);
  visit("element_steps_per_second", s.element_steps_per_second);
  visit("end_time", s.end_time);
  visit("energy_error", s.energy_error);
  visit("identity_error", s.identity_error);
  visit("momentum_error", s.momentum_error);
  visit("spin_error", s.spin_error);
  visit("penetration_ratio", s.penetration_ratio);
  visit("deepest_penetration", s.deepest_penetration);
  visit("verdict", s.verdict);
  visit("reasons", s.reasons);
  visit("warnings", s.warnings);
  visit("stop_reason", s.stop_reason);
  visit("masses", s.masses);
  visit("bodies", s.bodies);
  visit("obstacles", s.obstacles);
  visit("observed", s.observed);
  visit("time_step", s.time_step);
  visit("ledger", s.ledger);
  visit("momentum", s.momentum);
  visit("spin", s.spin);
  visit("histories", s.histories);
  visit("contacts", s.contacts);
}

std::string to_json(const Summary& summary) {
  Json out{{"schema", summary_schema}};
  out.update(json_of(summary));
  // Names that are not UTF-8 must not stop the summary of a finished run.
  return out.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

Summary summary_from_json(std::string_view text) {
  try {
    const Json json = Json::parse(text);
    if (json.at("schema") != summary_schema)
      throw OutputError(fmt::format("the summary is not of schema {}", summary_schema));
    Summary summary;
    read_json(json, summary);
    return summary;
  } catch (const Json::exception& error) {
    throw OutputError(fmt::format("not a summary of a run: {}", error.what()));
  }
}

void write_summary(const std::filesystem::path& path, const Summary& summary) { write_file(path, to_json(summary)); }

Summary read_summary(const std::filesystem::path& path) {
  constexpr std::size_t most_bytes = std::size_t{1} << 26;
  const std::string text = read_file(path, most_bytes);
  try {
    return summary_from_json(text);
  } catch (const OutputError& error) {
    throw OutputError(fmt::format("cannot read {}: {}", path.string(), error.what()));
  }
}

}  // namespace udar
