#include "udar/results/summary_numbers.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace udar {
namespace {

/// The largest distance of a body from the origin, m.
double length_of(const Summary& summary) {
  double length = 0;
  for (const auto& [observer, columns] : summary.histories) {
    for (const auto& [name, h] : columns) {
      if (name.starts_with("position_") && h.max_abs > length) length = h.max_abs;
    }
  }
  return length;
}

class Numbers {
 public:
  explicit Numbers(const Summary& summary) : scales_(summary) {}

  void add(std::string name, std::string unit, double value, double scale = 0) {
    if (!std::isfinite(value)) return;
    scale = std::max(scale, scales_.of(unit));
    found.push_back({std::move(name), std::move(unit), value, scale});
  }
  void add(const std::string& name, const std::string& unit, Vec2 value) {
    const double length = std::hypot(value.x, value.y);
    add(name + ".x", unit, value.x, length);
    add(name + ".y", unit, value.y, length);
  }
  /// May rounding errors be all that a column is?
  [[nodiscard]] bool is_noise(double largest, const std::string& unit, double scale) const {
    return !(largest > rounding_part * std::max(scale, scales_.of(unit)));
  }

  std::vector<SummaryNumber> found;

 private:
  RunScales scales_;
};

void add_ledger(Numbers& numbers, const LedgerSummary& l) {
  const std::array<std::pair<const char*, double>, 15> terms{{{"start", l.start},
                                                              {"kinetic", l.kinetic},
                                                              {"elastic", l.elastic},
                                                              {"plastic", l.plastic},
                                                              {"stored_elastic", l.stored_elastic},
                                                              {"contact", l.contact},
                                                              {"ties", l.ties},
                                                              {"friction", l.friction},
                                                              {"dropped", l.dropped},
                                                              {"damping", l.damping},
                                                              {"gravity", l.gravity},
                                                              {"loads", l.loads},
                                                              {"supports", l.supports},
                                                              {"obstacles", l.obstacles},
                                                              {"total", l.total}}};
  for (const auto& [name, value] : terms) numbers.add(std::string("ledger.") + name, "J", value);
}

/// Of momentum or of spin, without its error.
template <class Balance>
void add_balance(Numbers& numbers, const std::string& name, const std::string& unit, const Balance& b) {
  numbers.add(name + ".start", unit, b.start);
  numbers.add(name + ".end", unit, b.end);
  numbers.add(name + ".obstacles", unit, b.obstacles);
  numbers.add(name + ".gravity", unit, b.gravity);
  numbers.add(name + ".loads", unit, b.loads);
  numbers.add(name + ".supports", unit, b.supports);
  numbers.add(name + ".damping", unit, b.damping);
}

void add_history(Numbers& numbers, const std::string& observer, const std::map<std::string, HistorySummary>& columns) {
  std::map<std::string, double> scales;  // by unit: the components of a vector have one
  for (const auto& [name, h] : columns) {
    double& scale = scales[unit_of_quantity(observer, name)];
    if (std::isfinite(h.max_abs)) scale = std::max(scale, h.max_abs);
  }
  for (const auto& [name, h] : columns) {
    if (is_bookkeeping(observer, name)) continue;
    const std::string unit = unit_of_quantity(observer, name);
    const std::string path = fmt::format("histories.{}.{}.", observer, name);
    const double scale = scales.at(unit);
    numbers.add(path + "min", unit, h.min, scale);
    numbers.add(path + "max", unit, h.max, scale);
    numbers.add(path + "max_abs", unit, h.max_abs, scale);
    numbers.add(path + "last", unit, h.last, scale);
    if (numbers.is_noise(h.max_abs, unit, scale)) continue;  // when it was largest is nothing
    numbers.add(path + "time_of_min", "s", h.time_of_min);
    numbers.add(path + "time_of_max", "s", h.time_of_max);
  }
}

void add_episode(Numbers& numbers, const std::string& path, const EpisodeSummary& e) {
  numbers.add(path + "first_touch", "s", e.first_touch);
  numbers.add(path + "separation", "s", e.separation);
  if (std::isfinite(e.separation)) numbers.add(path + "duration", "s", e.duration);
  numbers.add(path + "impulse", "N s", e.impulse);
  numbers.add(path + "peak_force", "N", e.peak_force);
  numbers.add(path + "velocity_before", "m/s", e.velocity_before);
  numbers.add(path + "velocity_after", "m/s", e.velocity_after);
  numbers.add(path + "restitution", "", e.restitution);
  numbers.add(path + "tangential_restitution", "", e.tangential_restitution);
  numbers.add(path + "slip_velocity_before", "m/s", e.slip_velocity_before);
  numbers.add(path + "slip_velocity_after", "m/s", e.slip_velocity_after);
  for (const auto& [body, spin] : e.spin_before)
    numbers.add(fmt::format("{}spin_before.{}", path, body), "kg m^2/s", spin);
  for (const auto& [body, spin] : e.spin_after)
    numbers.add(fmt::format("{}spin_after.{}", path, body), "kg m^2/s", spin);
}

void add_contact(Numbers& numbers, const std::string& name, const ContactSummary& c) {
  const std::string path = fmt::format("contacts.{}.", name);
  numbers.add(path + "first_touch", "s", c.first_touch);
  numbers.add(path + "last_separation", "s", c.last_separation);
  if (std::isfinite(c.last_separation)) {  // else the end of the run would pass for that of the contact
    numbers.add(path + "duration", "s", c.duration);
    numbers.add(path + "duration_99", "s", c.duration_99);
  }
  numbers.add(path + "impulse", "N s", c.impulse);
  numbers.add(path + "peak_force", "N", c.peak_force);
  for (std::size_t k = 0; k < c.episodes.size(); ++k) {
    add_episode(numbers, fmt::format("{}episodes.{}.", path, k), c.episodes[k]);
  }
}

}  // namespace

double first_touch(const Summary& summary) {
  double first = no_number;
  for (const auto& [name, contact] : summary.contacts) first = std::fmin(first, contact.first_touch);
  return first;
}

bool is_bookkeeping(std::string_view history, std::string_view column) {
  const bool book = history == "energy" || history == "momentum";
  return column == "touching_nodes" || column == "flows" || (book && column.starts_with("error"));
}

RunScales::RunScales(const Summary& s)
    : energy_(std::max(std::fabs(s.ledger.start), std::fabs(s.ledger.total))),
      length_(length_of(s)),
      rate_(s.end_time > 0 ? 1 / s.end_time : 0) {
  double mass = 0;
  for (const auto& [body, m] : s.masses) mass += m;
  momentum_ = std::sqrt(2 * mass * energy_);
  velocity_ = mass > 0 ? momentum_ / mass : 0;
}

double RunScales::of(std::string_view unit) const {
  if (unit == "J") return energy_;
  if (unit == "kg m/s" || unit == "N s") return momentum_;
  if (unit == "m/s") return velocity_;
  if (unit == "kg m^2/s") return momentum_ * length_;
  if (unit == "m/s^2") return velocity_ * rate_;
  if (unit == "N") return momentum_ * rate_;
  if (unit == "N m") return momentum_ * rate_ * length_;
  return 0;
}

std::string unit_of_quantity(std::string_view history, std::string_view column) {
  if (history == "energy") return "J";
  constexpr std::array<std::pair<std::string_view, const char*>, 15> known{{{"position", "m"},
                                                                            {"displacement", "m"},
                                                                            {"velocity", "m/s"},
                                                                            {"angular_velocity", "rad/s"},
                                                                            {"acceleration", "m/s^2"},
                                                                            {"momentum", "kg m/s"},
                                                                            {"spin", "kg m^2/s"},
                                                                            {"stress", "Pa"},
                                                                            {"principal", "Pa"},
                                                                            {"max_shear", "Pa"},
                                                                            {"force", "N"},
                                                                            {"reaction", "N"},
                                                                            {"moment", "N m"},
                                                                            {"impulse", "N s"},
                                                                            {"angle", "rad"}}};
  for (const auto& [stem, unit] : known) {
    if (column == stem || column.starts_with(std::string(stem) + "_")) return unit;
  }
  return history == "momentum" ? "N s" : "";
}

std::vector<SummaryNumber> numbers_of(const Summary& s) {
  Numbers numbers(s);
  numbers.add("energy_error", "", s.energy_error);
  numbers.add("penetration_ratio", "", s.penetration_ratio);
  numbers.add("deepest_penetration.depth", "m", s.deepest_penetration.depth);
  numbers.add("deepest_penetration.time", "s", s.deepest_penetration.time);
  for (const auto& [body, mass] : s.masses) numbers.add("masses." + body, "kg", mass);
  add_ledger(numbers, s.ledger);
  add_balance(numbers, "momentum", "N s", s.momentum);
  add_balance(numbers, "spin", "kg m^2/s", s.spin);
  for (const auto& [observer, columns] : s.histories) add_history(numbers, observer, columns);
  for (const auto& [name, contact] : s.contacts) add_contact(numbers, name, contact);
  return std::move(numbers.found);
}

}  // namespace udar
