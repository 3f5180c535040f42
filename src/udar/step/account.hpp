#pragma once

#include "udar/base/vec2.hpp"

namespace udar {

/// Forces of one kind now, and their power with the velocities of the last and of the coming step.
struct Account {
  Vec2 force{};
  double power_before = 0;
  double power_after = 0;
  double moment = 0;  ///< about the origin; only of forces from outside the bodies

  void add(Vec2 f, Vec2 before, Vec2 after) {
    force += f;
    power_before += dot(f, before);
    power_after += dot(f, after);
  }
  Account& operator+=(const Account& other) {
    force += other.force;
    power_before += other.power_before;
    power_after += other.power_after;
    moment += other.moment;
    return *this;
  }
};

}  // namespace udar
