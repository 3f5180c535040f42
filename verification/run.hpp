#pragma once

#include <functional>

#include "udar/base/sym_tensor.hpp"
#include "udar/case/build_model.hpp"
#include "udar/step/step.hpp"

namespace udar::verification {

/// A case on its way: the model, the state, and the steps between.
struct Run {
  explicit Run(const Case& input, int threads = 1)
      : model(build_model(input)), work(model, threads), state(start(model, work)) {}
  Run(const Run&) = delete;

  [[nodiscard]] double time() const { return state.clock.time.value(); }
  [[nodiscard]] bool done() const { return finished(model, state); }
  void step() { udar::step(model, state, work); }
  /// To the end, calling `look` at t_0 and after every step.
  void run(const std::function<void(const Run&)>& look = nullptr) {
    if (look) look(*this);
    while (!done()) {
      step();
      if (look) look(*this);
    }
  }
  [[nodiscard]] Vec2 displacement(Index node) const {
    return Vec2{state.nodes[node].x, state.nodes[node].y} - model.rest[node];
  }

  Model model;
  Workspace work;
  State state;
};

/// R s R^T.
inline SymTensor<double> turned(const SymTensor<double>& s, Turn r) {
  const double cross = 2 * r.cos * r.sin * s.xy;
  return {r.cos * r.cos * s.xx - cross + r.sin * r.sin * s.yy, r.sin * r.sin * s.xx + cross + r.cos * r.cos * s.yy,
          r.cos * r.sin * (s.xx - s.yy) + (r.cos * r.cos - r.sin * r.sin) * s.xy, s.zz};
}

}  // namespace udar::verification
