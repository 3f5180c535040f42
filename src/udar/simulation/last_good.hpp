#pragma once

#include "udar/step/step.hpp"

namespace udar {

/// Brings back the state before a step that failed in its middle: a copy made now and then, and the steps since done
/// again, which give the same bits. A copy in every step would cost a third of the time, this costs less than 1 %.
/// External forces are kept only where there may be any.
class LastGood {
 public:
  explicit LastGood(const Model& model) : model_(model) {}

  /// To be called before every step.
  void keep(const State& state) {
    constexpr std::uint64_t steps_between_copies = 256;
    if (state.clock.step % steps_between_copies == 0) copy(state);
  }
  /// The state that the step to number `failed` began with.
  [[nodiscard]] State before(std::uint64_t failed, Workspace& work) const {
    State state = copy_;
    state.external.assign(model_.rest.size(), {});
    for (std::size_t k = 0; k < pushes_.size(); ++k) state.external[model_.pushed_nodes[k]] = pushes_[k];
    while (state.clock.step + 1 < failed) step(model_, state, work);
    return state;
  }

 private:
  void copy(const State& state) {
    std::vector<const void*> from;
    for_each_field(state, [&](const char*, const auto& field) { from.push_back(&field); });
    std::size_t k = 0;
    for_each_field(copy_, [&](const char*, auto& field) {
      const auto& original = *static_cast<const std::decay_t<decltype(field)>*>(from[k++]);
      if (static_cast<const void*>(&field) != &copy_.external) field = original;
    });
    pushes_.clear();
    for (const Index node : model_.pushed_nodes) pushes_.push_back(state.external[node]);
  }

  const Model& model_;
  State copy_;
  std::vector<Vec2> pushes_;  ///< N, external forces at the pushed nodes
};

}  // namespace udar
