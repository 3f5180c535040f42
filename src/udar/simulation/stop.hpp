#pragma once

#include <string>
#include <vector>

#include "udar/base/error.hpp"

namespace udar {

/// Why a run stopped, and what there is to say of it.
struct Stop {
  std::string reason = "end_time";
  std::vector<std::string> why;
  Culprit culprit;  ///< of a numerical failure

  void because(const char* new_reason, const std::string& text) {
    reason = new_reason;
    if (why.empty() || why.back() != text) why.push_back(text);
  }
  /// Does something that writes. Where the disk refuses, the run has stopped by that, and the rest may still be
  /// written.
  template <class Write>
  void save(Write&& write) {
    try {
      write();
    } catch (const OutputError& error) {
      because("disk", error.what());
    }
  }
  /// Nothing is left that resuming could do: the end is reached, or would fail again.
  [[nodiscard]] bool is_final() const { return reason == "end_time" || reason == "numerical"; }
};

}  // namespace udar
