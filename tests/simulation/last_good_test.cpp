#include "udar/simulation/last_good.hpp"

#include <doctest/doctest.h>

#include "tests/simulation/example.hpp"
#include "udar/case/build_model.hpp"

namespace udar {

TEST_CASE("the state before any step comes back with every bit") {
  Case input = falling_block();
  input.supports = {{.name = "hand", .nodes = {.body = "block", .side = "left"}, .move_x = TimeTable::constant(0)}};
  input.run.time_step = 0.1e-6;
  const Model model = build_model(input);
  Workspace work(model, 1);
  State state = start(model, work);
  LastGood last_good(model);
  bool pushed = false;
  for (std::uint64_t step_number = 1; step_number <= 515; ++step_number) {
    last_good.keep(state);
    pushed = pushed || state.obstacles[0].touching > 0;
    if (step_number % 103 == 0 || (step_number - 1) % 256 < 2) {
      CAPTURE(step_number);
      CHECK(hash_of(last_good.before(step_number, work)) == hash_of(state));
    }
    step(model, state, work);
  }
  CHECK(pushed);
}

}  // namespace udar
