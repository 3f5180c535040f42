// What contact costs in a step: a heap of discs, and the short beam on its stop. Prints a line of JSON.

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <fstream>

#include "discs.hpp"
#include "timed_step.hpp"
#include "udar/base/error.hpp"
#include "udar/case/build_model.hpp"
#include "udar/case/case_file.hpp"
#include "udar/step/step.hpp"

namespace {

using namespace udar;
using heap::StageTimes;

struct Options {
  std::string what = "heap";
  int discs = 400;
  int threads = 1;
  int before = 200;
  int steps = 1000;
  std::string write;
  bool check = false;
};

Model model_of(const Options& o) {
  if (o.what == "one") {
    const heap::OneBody one = heap::one_body(o.discs);
    return build_model(one.input, {one.mesh});
  }
  if (o.what == "beam") return build_model(load_case(UDAR_SOURCE_DIR "/cases/short-beam/short-beam.toml"));
  return build_model(heap::case_of(o.discs, o.what == "apart" ? heap::Layout::apart : heap::Layout::heap));
}

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// Does the step with clocks give the same bits as the step?
bool same_steps(const Model& model, const Options& o) {
  Workspace one(model, o.threads), other(model, o.threads);
  State a = start(model, one), b = start(model, other);
  StageTimes times;
  for (int n = 0; n < o.steps; ++n) {
    step(model, a, one);
    heap::timed_step(model, b, other, times);
  }
  return std::memcmp(a.nodes.data(), b.nodes.data(), a.nodes.size() * sizeof(NodeRecord)) == 0;
}

/// Bodies that touch another one or an obstacle now.
std::size_t in_touch(const Model& model, const State& state) {
  std::vector<char> touches(model.bodies.size());
  const std::size_t points = model.contact_nodes.size();
  for (const BodyTouch& touch : state.touches) touches[model.contact_bodies[touch.point]] = touches[touch.body] = 1;
  for (std::size_t c = 0; c < state.contacts.size(); ++c) {
    if (state.contacts[c].touches != 0) touches[model.contact_bodies[c % points]] = 1;
  }
  return static_cast<std::size_t>(std::count(touches.begin(), touches.end(), 1));
}

void measure(const Options& o) {
  const Model model = model_of(o);
  Workspace work(model, o.threads);
  State state = start(model, work);
  for (int n = 0; n < o.before; ++n) step(model, state, work);
  // The same steps twice, on copies that go on with the same bits: whole ones, and with clocks between their parts.
  double seconds = 0;
  {
    State plain = state;
    Workspace room(model, o.threads);
    step(model, plain, room);  // makes its list of near segments
    const auto begin = std::chrono::steady_clock::now();
    for (int n = 1; n < o.steps; ++n) step(model, plain, room);
    seconds = seconds_since(begin);
  }
  StageTimes times;
  double touching = 0;
  for (int n = 0; n < o.steps; ++n) {
    heap::timed_step(model, state, work, times);
    touching += static_cast<double>(in_touch(model, state));
  }
  const double per_step = 1e6 / o.steps;
  fmt::print(
      "{{\"what\": \"{}\", \"bodies\": {}, \"elements\": {}, \"threads\": {}, \"steps\": {}, \"us_per_step\": {:.3f}, "
      "\"in_touch\": {:.1f}, \"us_touch_bodies\": {:.3f}, \"us_contact_forces\": {:.3f}, \"us_books\": {:.3f}, "
      "\"us_timed\": {:.3f}}}\n",
      o.what, model.bodies.size(), model.element_count, o.threads, o.steps, 1e6 * seconds / (o.steps - 1),
      touching / o.steps, per_step * times.touch_bodies, per_step * times.contact_forces, per_step * times.books,
      per_step * times.all);
}

int run(const Options& o) {
  if (!o.write.empty()) {
    Case c = heap::case_of(o.discs, heap::Layout::heap);
    c.run.end_time = 1e-3;
    std::ofstream(o.write) << to_toml(c);
    return 0;
  }
  if (!o.check) {
    measure(o);
    return 0;
  }
  const bool same = same_steps(model_of(o), o);
  fmt::print("timed steps give {} bits\n", same ? "the same" : "other");
  return same ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Time of a step and of contact in it."};
  Options o;
  app.add_option("--what", o.what, "heap; apart: nothing touches; one: as one body; beam: the short beam")
      ->check(CLI::IsMember({"heap", "apart", "one", "beam"}));
  app.add_option("--discs", o.discs)->check(CLI::Range(4, 1000000));
  app.add_option("--threads", o.threads, "clocks within the sweep run with one only")->check(CLI::Range(1, 256));
  app.add_option("--before", o.before, "steps that are not timed")->check(CLI::Range(0, 1000000));
  app.add_option("--steps", o.steps, "steps that are timed")->check(CLI::Range(2, 10000000));
  app.add_option("--write", o.write, "only write the heap as a case file");
  app.add_flag("--check", o.check, "only compare the bits of timed and plain steps");
  CLI11_PARSE(app, argc, argv);
  try {
    return run(o);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
