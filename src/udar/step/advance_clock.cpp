#include "udar/step/stages.hpp"

namespace udar {

void advance_clock(const Model& model, State& state) {
  Clock& clock = state.clock;
  clock.second_step_before = clock.step_before;
  clock.step_before = clock.last_step;
  clock.last_step = clock.next_step;
  clock.time.add(clock.next_step);
  if (clock.next_is_last != 0) clock.time = {model.run.end_time, 0};  // exactly, whatever the sum rounds to
  ++clock.step;
}

}  // namespace udar
