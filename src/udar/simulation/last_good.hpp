#pragma once

#include "udar/step/step.hpp"

namespace udar {

/// Brings back the state before a step that failed in its middle: a copy made now and then, and the steps since done
/// again, which give the same bits. A copy in every step would cost a third of the time, this costs less than 1 %.
class LastGood {
 public:
  explicit LastGood(const Model& model) : model_(model) {}

  /// To be called before every step.
  void keep(const State& state) {
    constexpr std::uint64_t steps_between_copies = 256;
    if (state.clock.step % steps_between_copies == 0 || copy_.nodes.empty()) copy_ = state;
  }
  /// The state that the step to number `failed` began with.
  [[nodiscard]] State before(std::uint64_t failed, Workspace& work) const {
    State state = copy_;
    while (state.clock.step + 1 < failed) step(model_, state, work);
    return state;
  }

 private:
  const Model& model_;
  State copy_;
};

}  // namespace udar
