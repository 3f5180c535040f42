#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>

#include "check.hpp"
#include "run.hpp"

namespace {

using namespace roof;

/// Cells along the beam so that it has about so many elements; a multiple of 4, since it is a quarter as high.
Index columns_for(double elements) {
  return static_cast<Index>(4 * std::max(1.0, std::round(std::sqrt(2 * elements) / 4)));
}

const char* name_of(Variant variant) { return variant == Variant::fused ? "fused" : "sweep"; }

/// One line of JSON. A roof that blew up would be a wrong measure: its numbers may be infinite, and slower or faster.
bool measure(const Settings& settings, double simulated) {
  Problem p = build(settings, slots_of_lanes());
  const auto steps = static_cast<std::uint64_t>(std::max(1.0, std::round(simulated / p.step)));
  const double seconds = run(p, steps);
  double fastest = 0;
  for (Index i = 0; i < p.node_count; ++i) fastest = std::max(fastest, std::fabs(p.nodes[i].vy));
  const bool sound = fastest > 0 && fastest < 100 * p.beam.speed;
  fmt::print(
      "{{\"elements\": {}, \"threads\": {}, \"variant\": \"{}\", \"lanes\": {}, \"steps\": {}, \"seconds\": {:.4f}, "
      "\"million_element_steps_per_second\": {:.2f}, \"sound\": {}}}\n",
      p.elements, settings.threads, name_of(settings.variant), slots_of_lanes().size(), steps, seconds,
      1e-6 * p.elements * static_cast<double>(steps) / seconds, sound);
  return sound;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"The roof: how fast a step's physics can go on this machine. Prints one line of JSON for each variant."};
  double elements = 12800;
  double simulated = 2e-3;
  int threads = 1;
  std::string variant = "both";
  bool check = false;
  app.add_option("--elements", elements, "about so many")->check(CLI::Range(8.0, 1e8));
  app.add_option("--threads", threads)->check(CLI::Range(1, 256));
  app.add_option("--simulated", simulated, "how long the impact is followed, s")->check(CLI::PositiveNumber);
  app.add_option("--variant", variant)->check(CLI::IsMember({"both", "sweep", "fused"}));
  app.add_flag("--check", check, "compares with the program instead");
  CLI11_PARSE(app, argc, argv);

  if (check) return check_against_program() ? 0 : 1;
  const Index columns = columns_for(elements);
  if (columns * columns / 4 < static_cast<Index>(threads) * pairs_per_stretch) {
    fmt::print(stderr, "too few elements for {} threads\n", threads);
    return 2;
  }
  bool sound = true;
  for (const Variant v : {Variant::sweep, Variant::fused}) {
    if (variant == "both" || variant == name_of(v)) sound = measure({columns, threads, v}, simulated) && sound;
  }
  return sound ? 0 : 1;
}
