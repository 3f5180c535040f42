#include "udar/simulation/simulation.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>

#include "udar/case/build_model.hpp"
#include "udar/output/summarise.hpp"
#include "udar/results/file.hpp"
#include "udar/simulation/checkpoint.hpp"
#include "udar/simulation/last_good.hpp"
#include "udar/simulation/machine.hpp"
#include "udar/simulation/run_output.hpp"
#include "udar/step/step.hpp"

namespace udar {

namespace {

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace

int threads_for(std::size_t elements) {
  constexpr std::size_t elements_per_thread = 4000;
  const auto most = static_cast<std::size_t>(available_threads());
  return static_cast<int>(std::clamp<std::size_t>(elements / elements_per_thread, 1, most));
}

std::string version_text() {
#if defined(__clang__)
  constexpr const char* compiler = "clang";
#else
  constexpr const char* compiler = "g++";
#endif
  return fmt::format("udar {} ({} {})", version_number(), compiler, __VERSION__);
}

std::string version_number() { return UDAR_VERSION; }

Simulation::Simulation(Case input) : case_(std::move(input)), model_((check_case(case_), build_model(case_))) {}

void Simulation::observe(std::function<void(const Model&, const State&)> watch) {
  watchers_.push_back(std::move(watch));
}

void Simulation::compute(const RunOptions& options, Workspace& work, Stop& stop, const std::function<void()>& look) {
  LastGood last_good(model_);
  while (!finished(model_, state_)) {
    if (options.interrupted && options.interrupted()) {
      return stop.because("interrupted", "the run was interrupted before its end time");
    }
    last_good.keep(state_);
    try {
      step(model_, state_, work);
    } catch (const NumericalError& failure) {
      state_ = last_good.before(state_.clock.step, work);
      stop.culprit = failure.culprit;
      return stop.because("numerical", failure.what());
    }
    look();
  }
}

Summary Simulation::run(const RunOptions& options) {
  const auto begin = std::chrono::steady_clock::now();
  RunSoFar before{.case_name = options.case_name, .case_text = to_toml(case_), .started = now_text()};
  if (options.resume != nullptr) {
    before = options.resume->run;
    ++before.resumed;
  }
  Workspace work(model_, options.threads > 0 ? options.threads : threads_for(model_.element_count));
  state_ = options.resume != nullptr ? state_of(*options.resume, model_) : start(model_, work);
  RunOutput output(case_, model_, state_, options, work.pool);
  if (options.resume != nullptr) options.resume->file.clear();

  const auto first_step = std::chrono::steady_clock::now();
  const auto so_far = [&] {
    RunSoFar now = before;
    now.wall_seconds += seconds_since(begin);
    now.stepping_seconds += seconds_since(first_step);
    return now;
  };
  Stop stop;
  stop.save([&] {
    if (options.resume == nullptr) output.record(state_);
    watch();
    compute(options, work, stop, [&] {
      output.record(state_);
      watch();
      if (output.checkpoint_is_due()) output.checkpoint(so_far(), state_);
    });
    // Before the last rows and the last frame, which a run that was never stopped does not have.
    if (stop.reason == "interrupted") output.checkpoint(so_far(), state_);
  });

  const RunSoFar after = so_far();
  const Summary sums = summarise(model_, state_);
  const auto conclude = [&] {
    Summary s = sums;
    s.version = version_text();
    s.case_name = after.case_name;
    s.started = after.started;
    s.machine = this_machine();
    s.threads = work.pool.threads();
    s.resumed = static_cast<int>(after.resumed);
    s.wall_seconds = after.wall_seconds;
    s.stepping_seconds = after.stepping_seconds;
    s.element_steps_per_second = static_cast<double>(s.elements) * static_cast<double>(s.steps) / s.stepping_seconds;
    s.stop_reason = stop.reason;
    s.reasons = stop.why;
    output.summarise(s);
    judge(model_, state_, s);
    return s;
  };
  output.close(state_, stop, conclude);
  return conclude();
}

}  // namespace udar
