#pragma once

#include <cstdint>

namespace udar {

/// Says when a run passes the multiples of an interval, 0 included. Multiple k is due at k times the interval: nothing
/// is added up, and steps are never changed for it.
class Multiples {
 public:
  /// `interval` in s; 0: there are none.
  explicit Multiples(double interval) : interval_(interval) {}

  /// True where at least one multiple has been reached since the last call.
  bool reached(double time) {
    if (!(interval_ > 0)) return false;
    // A hair early counts: k times the interval and a sum of steps round differently.
    const double ratio = time / interval_ * (1 + 1e-12) + 1e-9;
    constexpr double most = 1e18;  // of an interval of next to nothing, or of a time that is none
    const auto count = static_cast<std::uint64_t>(ratio < most ? ratio : most) + 1;
    const bool more = count > done_;
    if (more) done_ = count;
    return more;
  }

  template <class Archive>
  void carry(Archive& archive) {
    archive(done_);
  }

 private:
  double interval_;
  std::uint64_t done_ = 0;
};

}  // namespace udar
