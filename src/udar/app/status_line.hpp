#pragma once

#include <chrono>

#include "udar/model/model.hpp"
#include "udar/model/state.hpp"

namespace udar {

/// One line that tells how a run stands: rewritten in place on a terminal, a plain line now and then elsewhere.
class StatusLine {
 public:
  StatusLine();
  /// To be called after every step; looks at the clock only now and then.
  void update(const Model& model, const State& state);
  /// The last line, for good.
  void finish(const Model& model, const State& state);

 private:
  void print(const Model& model, const State& state);

  bool terminal_;
  bool headed_ = false;
  std::chrono::steady_clock::time_point begin_;
  std::chrono::steady_clock::time_point next_;
};

}  // namespace udar
