#include <sys/resource.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>

#include "udar/app/commands.hpp"
#include "udar/app/terminal.hpp"
#include "udar/output/frame_writer.hpp"
#include "udar/output/run_pictures.hpp"
#include "udar/output/summarise.hpp"
#include "udar/output/thin_obstacles.hpp"
#include "udar/report/drawing.hpp"
#include "udar/simulation/last_good.hpp"
#include "udar/simulation/simulation.hpp"
#include "udar/step/integrators.hpp"
#include "udar/step/step.hpp"

namespace udar {
namespace {

using std::chrono::steady_clock;

constexpr const char* check_footer = R"(Examples:
  udar check cases/short-beam/short-beam.toml --set bodies.beam.mesh.element_size="0.5 cm"
  udar check cases/short-beam/short-beam.toml --picture setup.png)";

/// One row of the report; rows of one kind say so only once.
void row(std::string_view label, std::string_view name, const std::string& text) {
  say("  {:<11}{}{}{}\n", label, name, name.empty() ? "" : ": ", text);
}

/// Bytes that this process has held at most: once it has done some steps, what a run will. Asked of the system, since a
/// list of arrays would be out of date with the next one.
double memory_so_far() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return 1024.0 * static_cast<double>(usage.ru_maxrss);
}

/// Of a heap of bodies a screen shows the first ones.
constexpr std::size_t most_bodies = 20;

void print_bodies(const Model& model) {
  const char* label = "bodies";
  for (const Body& body : std::span(model.bodies).first(std::min(most_bodies, model.bodies.size()))) {
    const Elasticity c = std::visit([](const auto& law) { return law.elasticity(); }, body.law);
    const char* law = std::visit([](const auto& l) { return std::decay_t<decltype(l)>::keyword; }, body.law);
    row(label, body.name,
        fmt::format("{:.6g} kg, {}, {}", body.mass, counted(body.element_end - body.element_begin, "element"),
                    counted(body.node_end - body.node_begin, "node")));
    row("", body.name,
        fmt::format("{}, {:.6g} kg/m^3, pressure waves {:.6g} m/s, shear waves {:.6g} m/s", law, body.density,
                    std::sqrt(c.wave_modulus() / body.density), std::sqrt(c.shear_modulus / body.density)));
    label = "";
  }
  if (model.bodies.size() > most_bodies) {
    row("", "", fmt::format("and {} more", model.bodies.size() - most_bodies));
  }
  for (const RigidBody& rigid : model.rigid_bodies) {
    if (rigid.body >= most_bodies) break;
    row("", model.bodies[rigid.body].name,
        fmt::format("rigid, inertia {:.6g} kg m^2 about its centre of mass at ({:.5g}, {:.5g}) m", rigid.inertia,
                    rigid.centre.x, rigid.centre.y));
  }
}

std::string range_in_units(const std::vector<double>& values, std::string_view unit) {
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  const std::string text = in_units(*least, unit);
  return *least == *most ? text : text + " to " + in_units(*most, unit);
}

void print_obstacles(const Model& model) {
  const char* label = "obstacles";
  for (const Obstacle& obstacle : model.obstacles) {
    const char* shape = std::visit([](const auto& s) { return std::decay_t<decltype(s)>::keyword; }, obstacle.shape);
    std::string text = fmt::format("{}, friction {:.4g}, springs of {} at each of {}", shape, obstacle.friction,
                                   range_in_units(obstacle.normal_stiffness, "N/m"),
                                   counted(static_cast<long long>(model.contact_nodes.size()), "outer node"));
    if (length(obstacle.velocity) > 0) {
      text += fmt::format(", moves with ({:.4g}, {:.4g}) m/s", obstacle.velocity.x, obstacle.velocity.y);
    }
    row(label, obstacle.name, text);
    label = "";
  }
}

long long ties_between(const Model& model, Index a, Index b) {
  return std::count_if(model.ties.begin(), model.ties.end(), [&](const Tie& tie) {
    const Index own = model.contact_bodies[tie.point];
    const Index other = model.segments[tie.segment].body;
    return (own == a && other == b) || (own == b && other == a);
  });
}

/// How bodies touch each other, and for which pairs something else holds.
void print_body_contact(const Model& model) {
  const auto text = [](const BodyPair& pair) {
    if (!pair.touch) return std::string("do not touch");
    if (pair.tied) return std::string("tied");
    return fmt::format("friction {:.4g}, springs {}", pair.friction,
                       pair.stiffness ? "of " + in_units(*pair.stiffness, "N/m") : "as stiff as the softer element");
  };
  const std::string usual = text(model.body_pairs.usual);
  if (model.bodies.size() > 1) row("contact", "", "of all bodies with each other and themselves: " + usual);
  for (const BodyPairs::Exception& exception : model.body_pairs.exceptions) {
    const bool rigid = exception.first == exception.second && model.bodies[exception.first].rigid;
    std::string own = text(exception.pair);
    if (rigid || own == usual) continue;
    if (exception.pair.tied) own += " at " + counted(ties_between(model, exception.first, exception.second), "node");
    row("", model.bodies[exception.first].name, fmt::format("with {}: {}", model.bodies[exception.second].name, own));
  }
}

void print_supports_and_loads(const Model& model) {
  const char* label = "supports";
  for (const Support& s : model.supports) {
    const char* how = s.turns ? "turned" : s.holds_x && s.holds_y ? "x and y given" : s.holds_x ? "x given" : "y given";
    row(label, s.name, fmt::format("{}, {}", counted(static_cast<long long>(s.nodes.size()), "node"), how));
    label = "";
  }
  label = "loads";
  for (const Load& l : model.loads) {
    row(label, l.name,
        l.edges.empty() ? fmt::format("on {}", counted(static_cast<long long>(l.nodes.size()), "node"))
                        : fmt::format("{} on {}", in_units(l.pressure, "Pa"),
                                      counted(static_cast<long long>(l.edges.size()), "edge")));
    label = "";
  }
}

void print_observers(const Model& model) {
  std::string names;
  for (const auto& o : model.observed_nodes) names += ", " + o.name;
  for (const auto& o : model.observed_elements) names += ", " + o.name;
  for (const auto& o : model.observed_regions) names += ", " + o.name;
  if (!names.empty()) row("observed", "", names.substr(2));
  const OutputSettings& output = model.output;
  std::string fields = "no fields";
  if (output.fields_every > 0) fields = "fields every " + in_units(output.fields_every, "s");
  if (!output.fields_at.empty()) {
    fields = output.fields_every > 0 ? fields + " and at" : "fields at";
    fields += " " + counted(static_cast<long long>(output.fields_at.size()), "given time");
  }
  row("written", "", fmt::format("histories every {}, {}", in_units(output.histories_every, "s"), fields));
}

void print_time_step(const Model& model, const Clock& clock) {
  const IntegratorRule& rule = rule_of(model.run.integrator);
  const std::string step =
      fmt::format("{} {}", in_units(clock.next_step, "s"), model.run.time_step ? "fixed" : "automatic");
  if (rule.stable_limit == 0) {
    const double z = 2 * *model.run.time_step / clock.limit.size;
    row("time step", "",
        fmt::format("{}; {} is never stable: the stiffest vibration grows by {:.3g} % in each step", step, rule.keyword,
                    100 * std::pow(z, 4) / 6));
  } else {
    row("time step", "",
        fmt::format("{}; stable up to {}, limited by {}{}", step, in_units(clock.limit.size, "s"),
                    element_name(model, clock.limit.element),
                    clock.limit.by_contact != 0 ? " and its contact springs" : ""));
  }
}

/// Seconds of one step, from a few done.
double step_seconds(const Model& model, State& state, Workspace& work) {
  const auto begin = steady_clock::now();
  const auto spent = [&] { return std::chrono::duration<double>(steady_clock::now() - begin).count(); };
  int steps = 0;
  try {
    while (!finished(model, state) && steps < 2000 && (steps < 10 || spent() < 0.2)) {
      step(model, state, work);
      ++steps;
    }
  } catch (const NumericalError& failure) {
    throw UserError(ExitCode::numerical, std::string("the case fails within its first steps: ") + failure.what());
  }
  return steps > 0 ? spent() / steps : 0;
}

/// Does a few steps to find out, with what a run keeps beside them.
void print_cost(const Model& model, State& state, Workspace& work) {
  const double steps = std::ceil(model.run.end_time / state.clock.next_step * (1 - 1e-9));
  row("steps", "", fmt::format("{:.0f}{}", steps, model.run.time_step ? "" : ", more as elements deform"));
  LastGood last_good(model);
  last_good.keep(state);
  const double each = step_seconds(model, state, work);
  const auto of_frames = static_cast<double>(memory_of_frames(model, state));
  row("memory", "", "about " + in_units(memory_so_far() + of_frames, "B"));
  const std::string threads = counted(work.pool.threads(), "thread");
  row("time", "", fmt::format("about {:.2g} s with {}, and what writing the fields takes", steps * each, threads));
}

struct CheckArguments {
  CaseArguments input;
  std::string picture;  ///< file; empty: none
  int width = 1600;     ///< px, of a PNG
};

ExitCode describe_case(const CheckArguments& check) {
  const CaseArguments& arguments = check.input;
  if (!check.picture.empty()) check_drawing(check.picture);
  std::vector<Diagnostic> warnings;
  const Simulation simulation(load_case(arguments.file, arguments.assignments, &warnings));
  const Model& model = simulation.model();
  Workspace work(model, threads_for(model.element_count));
  State state = start(model, work);
  for (Diagnostic& warning : obstacles_too_thin(model, state)) warnings.push_back(std::move(warning));
  print_warnings(warnings);
  if (!check.picture.empty()) {
    const std::string title = std::filesystem::path(arguments.file).stem().string();
    write_drawing(check.picture, to_svg(setup_picture(model, state, title)), check.width);
  }

  say("{}\n", std::filesystem::path(arguments.file).stem().string());
  row("run", "",
      fmt::format("0 to {}, {}, gravity ({:.4g}, {:.4g}) m/s^2", in_units(model.run.end_time, "s"),
                  rule_of(model.run.integrator).keyword, model.run.gravity.x, model.run.gravity.y));
  print_bodies(model);
  print_obstacles(model);
  print_body_contact(model);
  print_supports_and_loads(model);
  print_observers(model);
  print_time_step(model, state.clock);
  print_cost(model, state, work);
  if (!check.picture.empty()) row("picture", "", check.picture);
  say("0 errors, {}; nothing was run\n", counted(static_cast<long long>(warnings.size()), "warning"));
  return ExitCode::done;
}

}  // namespace

Command add_check(CLI::App& app) {
  CLI::App* words = app.add_subcommand("check", "Find every mistake in a case and tell what a run would be like");
  words->footer(check_footer);
  const auto arguments = std::make_shared<CheckArguments>();
  add_case_options(*words, arguments->input);
  words->add_option("--picture", arguments->picture, "Draw the set-up into this .svg, .png or .pdf")->type_name("FILE");
  add_width_option(*words, arguments->width);
  return {words, [arguments] { return describe_case(*arguments); }};
}

}  // namespace udar
