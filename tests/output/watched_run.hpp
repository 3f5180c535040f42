#pragma once

#include <functional>

#include "udar/case/build_model.hpp"
#include "udar/step/step.hpp"

namespace udar {

/// A case that a test steps through itself.
struct WatchedRun {
  explicit WatchedRun(const Case& input) : model(build_model(input)), work(model, 1), state(start(model, work)) {}
  WatchedRun(const WatchedRun&) = delete;

  /// Calls `look` at t_0 and after every step.
  void run(const std::function<void()>& look) {
    look();
    while (!finished(model, state)) {
      step(model, state, work);
      look();
    }
  }
  [[nodiscard]] double time() const { return state.clock.time.value(); }

  Model model;
  Workspace work;
  State state;
};

}  // namespace udar
