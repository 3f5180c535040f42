#include "timed_step.hpp"

#include <chrono>

#include "udar/step/failure.hpp"
#include "udar/step/stages.hpp"

namespace udar::heap {
namespace {

using Clock = std::chrono::steady_clock;

/// Adds the time until it is destroyed.
class Timer {
 public:
  explicit Timer(double& sum) : sum_(sum) {}
  Timer(const Timer&) = delete;
  Timer& operator=(const Timer&) = delete;
  ~Timer() { sum_ += std::chrono::duration<double>(Clock::now() - begin_).count(); }

 private:
  double& sum_;
  Clock::time_point begin_ = Clock::now();
};

void timed_sweep(const Model& model, State& state, Workspace& work, double& contact) {
  const NodeTask common = node_task(model, state);
  work.forces.for_each_block(
      work.pool, [&](std::size_t elements) { deform_elements(model, state, work, elements); },
      [&](std::size_t nodes, NodeForces& forces) {
        {
          const Timer timer(contact);
          add_contact_force(model, state, work, nodes, forces);
        }
        add_load_force(state, work, nodes, forces);
        add_support_force(model, state, work, nodes, forces);
        accelerate_nodes(model, state, work, nodes, forces, common);
      });
  refuse_inverted(model, state, work);
}

}  // namespace

void timed_step(const Model& model, State& state, Workspace& work, StageTimes& times) {
  const Timer timer(times.all);
  advance_clock(model, state);
  set_loads(model, state);
  set_supports(model, state, work);
  {
    const Timer bodies(times.touch_bodies);
    touch_bodies(model, state, work);
  }
  move_rigid_bodies(model, state, work);
  if (work.pool.threads() == 1) {
    timed_sweep(model, state, work, times.contact_forces);
  } else {
    sweep(model, state, work);
  }
  choose_time_step(model, state, work);
  const Timer books(times.books);
  close_books(model, state, work);
}

}  // namespace udar::heap
