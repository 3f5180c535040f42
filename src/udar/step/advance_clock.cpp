#include "udar/step/stages.hpp"

namespace udar {

void advance_clock(const Model& model, State& state) {
  Clock& clock = state.clock;
  clock.second_step_before = clock.step_before;
  clock.step_before = clock.last_step;
  clock.last_step = clock.next_step;
  clock.velocity_ahead = clock.next_velocity_ahead;
  clock.time.add(clock.next_step);
  if (clock.next_is_last != 0) clock.time = {model.run.end_time, 0};  // exactly, whatever the sum rounds to
  ++clock.step;
  clock.next_step = clock.following_step;
  clock.next_velocity_ahead = 0;
  clock.next_is_last = clock.following_is_last;
}

}  // namespace udar
