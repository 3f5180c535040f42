// The bits of many cases are those that are written down in golden_hashes.txt: for every number of threads, instruction
// set, compiler and build. Who changes them on purpose writes them anew (UDAR_WRITE_GOLDEN=1) and says why in
// CHANGELOG.md (tools/check_golden).

#include <doctest/doctest.h>
#include <fmt/core.h>

#include <algorithm>
#include <cstdlib>
#include <map>

#include "tests/simulation/example.hpp"
#include "tests/simulation/golden_cases.hpp"
#include "tests/step/kernels_here.hpp"
#include "udar/results/file.hpp"
#include "udar/step/step.hpp"

namespace udar {
namespace {

const std::string golden_file = std::string(UDAR_SOURCE_DIR) + "/tests/simulation/golden_hashes.txt";

/// What happened in a run, so that none of it is missing from all cases.
struct Events {
  std::map<std::string, int> cases;  ///< in which it happened

  void look(const Model& model, const State& state) {
    const auto note = [&](const char* what, bool happened) { now_[what] = now_[what] || happened; };
    const Ledger& ledger = state.ledger;
    const auto works = [&](ForceKind kind) { return ledger.book(kind).work_now != 0; };
    note(rule_of(model.run.integrator).keyword, true);
    note("elastic or plastic flow", ledger.plastic_work.value() > 0);
    note("contact with obstacles", std::any_of(state.contacts.begin(), state.contacts.end(),
                                               [](const SpringState& s) { return s.touches != 0; }));
    note("contact of bodies", !state.touches.empty());
    note("corners of obstacles", !state.corner_touches.empty());
    note("self contact", std::any_of(state.touches.begin(), state.touches.end(),
                                     [&](const BodyTouch& t) { return model.contact_bodies[t.point] == t.body; }));
    note("sliding", ledger.friction_work.value() > 0);
    note("touches that end with a stretched spring", ledger.dropped_energy.value() > 0);
    note("contact damping", works(ForceKind::contact_damping));
    note("ties", works(ForceKind::tie));
    note("gravity", works(ForceKind::gravity));
    note("loads", works(ForceKind::load));
    note("supports", works(ForceKind::support));
    note("mass damping", works(ForceKind::damping));
    note("moving obstacles", ledger.obstacle_work_now != 0);
    note("rigid bodies", !state.rigid.empty() && state.rigid[0].angle != 0);
    note("pairs of triangles", has_blocks(model, true));
    note("single triangles", has_blocks(model, false));
    note("more blocks than threads", model.element_blocks.size() > 16 && model.node_blocks.size() > 16);
  }
  void end_case() {
    for (const auto& [what, happened] : now_) cases[what] += happened ? 1 : 0;
    now_.clear();
  }

 private:
  static bool has_blocks(const Model& model, bool paired) {
    return std::any_of(model.element_blocks.begin(), model.element_blocks.end(),
                       [&](const ElementBlock& block) { return block.paired == paired; });
  }

  std::map<std::string, bool> now_;
};

std::vector<std::uint64_t> hashes_of(const Model& model, const std::vector<int>& steps, const BlockKernels& kernels,
                                     int threads, Events* events = nullptr) {
  Workspace work(model, threads);
  work.kernels = kernels;
  State state = start(model, work);
  std::vector<std::uint64_t> hashes;
  for (const int wanted : steps) {
    while (state.clock.step < static_cast<std::uint64_t>(wanted)) {
      step(model, state, work);
      if (events != nullptr) events->look(model, state);
    }
    hashes.push_back(hash_of(state));
  }
  if (events != nullptr) events->end_case();
  return hashes;
}

/// Lines "case step hash", as the file has them.
std::string lines_of(const GoldenCase& golden, const std::vector<std::uint64_t>& hashes) {
  std::string lines;
  for (std::size_t k = 0; k < hashes.size(); ++k)
    lines += fmt::format("{} {} {:016x}\n", golden.name, golden.steps[k], hashes[k]);
  return lines;
}

std::string lines_of(const std::string& file, const std::string& name) {
  std::string lines;
  for (std::size_t at = 0; at < file.size();) {
    const std::size_t end = file.find('\n', at) + 1;
    if (file.compare(at, name.size() + 1, name + " ") == 0) lines += file.substr(at, end - at);
    at = end;
  }
  return lines;
}

/// Builds that are slow, as those that look for other mistakes, leave out most numbers of threads.
std::vector<int> numbers_of_threads() {
#if defined(NDEBUG) && !defined(UDAR_SANITIZED)
  return {1, 2, 3, 4, 7, 8, 16};
#else
  return {1, 4};
#endif
}

}  // namespace

TEST_CASE("golden: the bits of every case are those written down, for any number of threads and instruction set") {
  const bool write = std::getenv("UDAR_WRITE_GOLDEN") != nullptr;
  const std::string written = write ? "" : read_file(golden_file, 1 << 20);
  const std::vector<NamedKernels> isas = kernels_here();
  Events events;
  std::string all;
  for (const GoldenCase& golden : golden_cases()) {
    CAPTURE(golden.name);
    const Model model = build_model(golden.input());
    const std::string first = lines_of(golden, hashes_of(model, golden.steps, isas.front().kernels, 1, &events));
    all += first;
    if (!write) CHECK(first == lines_of(written, golden.name));
    for (const NamedKernels& isa : isas) {
      for (const int threads : numbers_of_threads()) {
        if (threads == 1 && isa.name == isas.front().name) continue;
        CAPTURE(isa.name);
        CAPTURE(threads);
        CHECK(lines_of(golden, hashes_of(model, golden.steps, isa.kernels, threads)) == first);
      }
    }
  }
  for (const auto& event : events.cases) {
    CAPTURE(event.first);
    CHECK(event.second > 0);
  }
  if (write) write_file(golden_file, all);
  if (!write) CHECK(all.size() == written.size());  // no line of a case that is gone
}

}  // namespace udar
