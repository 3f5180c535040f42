#include <fmt/core.h>

#include <chrono>
#include <cmath>
#include <filesystem>

#include "udar/app/commands.hpp"
#include "udar/case/reference.hpp"
#include "udar/output/summarise.hpp"
#include "udar/simulation/simulation.hpp"
#include "udar/step/integrators.hpp"
#include "udar/step/step.hpp"

namespace udar {
namespace {

using std::chrono::steady_clock;

double seconds_since(steady_clock::time_point begin) {
  return std::chrono::duration<double>(steady_clock::now() - begin).count();
}

/// Bytes of everything that a run keeps for all its steps.
std::size_t memory_of(const Model& model, const State& state) {
  std::size_t bytes = 0;
  for_each_field(state, [&](const char*, const auto& field) {
    if constexpr (requires { field.size(); }) {
      bytes += field.size() * sizeof(field[0]);
    } else {
      bytes += sizeof field;
    }
  });
  bytes += model.rest.size() * (2 * sizeof(Vec2) + 2 * sizeof(double) + 2 * sizeof(Index));
  bytes += model.corners.size() * (2 * sizeof(Vec2) + 3 * sizeof(Vec2) + 6 * sizeof(Index));
  return bytes;
}

void print_bodies(const Model& model) {
  for (const Body& body : model.bodies) {
    const Elasticity c = std::visit([](const auto& law) { return law.elasticity(); }, body.law);
    const char* law = std::visit([](const auto& l) { return std::decay_t<decltype(l)>::keyword; }, body.law);
    fmt::print(" body {}: {} elements, {} nodes, {:.6g} kg\n", body.name, body.element_end - body.element_begin,
               body.node_end - body.node_begin, body.mass);
    fmt::print("   {}, {:.6g} kg/m^3: pressure waves {:.6g} m/s, shear waves {:.6g} m/s\n", law, body.density,
               std::sqrt(c.wave_modulus() / body.density), std::sqrt(c.shear_modulus / body.density));
  }
}

void print_obstacles(const Model& model) {
  for (const Obstacle& obstacle : model.obstacles) {
    const auto [softest, stiffest] =
        std::minmax_element(obstacle.normal_stiffness.begin(), obstacle.normal_stiffness.end());
    const char* shape = std::visit([](const auto& s) { return std::decay_t<decltype(s)>::keyword; }, obstacle.shape);
    fmt::print(" obstacle {}: {}, friction {:.3g}, springs {:.4g} to {:.4g} N/m at each of {} outer nodes\n",
               obstacle.name, shape, obstacle.friction, *softest, *stiffest, model.contact_nodes.size());
  }
}

/// Time of one step, from a few done on a copy.
double step_seconds(const Model& model, State state, Workspace& work) {
  const auto begin = steady_clock::now();
  int steps = 0;
  while (!finished(model, state) && steps < 2000 && (steps < 10 || seconds_since(begin) < 0.2)) {
    step(model, state, work);
    ++steps;
  }
  return steps > 0 ? seconds_since(begin) / steps : 0;
}

}  // namespace

ExitCode check_command(const RunArguments& arguments) {
  std::vector<Diagnostic> warnings;
  const Simulation simulation(load_case(arguments.case_file, arguments.assignments, &warnings));
  for (const Diagnostic& w : warnings) fmt::print(stderr, "warning{}", to_text(w).substr(5));
  const Model& model = simulation.model();
  Workspace work(model, threads_for(model));
  const State state = start(model, work);
  const Clock& clock = state.clock;

  fmt::print(" {}: to {:.6g} s with {}\n", std::filesystem::path(arguments.case_file).stem().string(),
             model.run.end_time, rule_of(model.run.integrator).keyword);
  print_bodies(model);
  print_obstacles(model);
  if (rule_of(model.run.integrator).stable_limit == 0) {
    const double z = 2 * *model.run.time_step / clock.limit.size;
    fmt::print(" step {:.4g} s; {} is never stable: the stiffest vibration grows by {:.3g} in each step\n",
               clock.next_step, rule_of(model.run.integrator).keyword, std::pow(z, 4) / 6);
  } else {
    fmt::print(" step {:.4g} s ({}); stable up to {:.4g} s, set by {}{}\n", clock.next_step,
               model.run.time_step ? "fixed" : "automatic", clock.limit.size, element_name(model, clock.limit.element),
               clock.limit.by_contact != 0 ? " and its contact springs" : "");
  }
  const double steps = std::ceil(model.run.end_time / clock.next_step);
  fmt::print(" {:.0f} steps{}, {:.3g} MB, about {:.3g} s with {} thread{}\n", steps,
             model.run.time_step ? "" : " or more, as elements deform",
             1e-6 * static_cast<double>(memory_of(model, state)), steps * step_seconds(model, state, work),
             work.pool.threads(), work.pool.threads() == 1 ? "" : "s");
  fmt::print(" {} error; ready to run\n", "no");
  return ExitCode::done;
}

ExitCode keys_command(const std::string& filter) {
  const std::string text = keys_text(filter);
  if (text.empty()) {
    fmt::print(stderr, "error: no key has to do with `{}`\n  = `udar keys` lists all\n", filter);
    return ExitCode::usage;
  }
  fmt::print("{}", text);
  return ExitCode::done;
}

}  // namespace udar
