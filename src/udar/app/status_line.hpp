#pragma once

#include <chrono>
#include <string>

#include "udar/model/model.hpp"
#include "udar/model/state.hpp"

namespace udar {

/// One line that tells how a run stands: rewritten in place on a terminal, a plain line now and then elsewhere.
class StatusLine {
 public:
  explicit StatusLine(double end_time);
  /// To be called after every step; looks at the clock only now and then.
  void update(const Model& model, const State& state);
  /// The last line, for good.
  void finish(const Model& model, const State& state);

 private:
  /// The unit in which a time is told, and how many of it are a second.
  struct TimeUnit {
    const char* name;
    double per_second;
  };
  static TimeUnit unit_for(double time);
  void print(const Model& model, const State& state, const std::string& left);

  bool terminal_;
  bool headed_ = false;
  TimeUnit unit_;
  TimeUnit step_unit_{};
  std::chrono::steady_clock::time_point begin_;
  std::chrono::steady_clock::time_point next_;
};

}  // namespace udar
