#include "udar/step/integrators.hpp"
#include "udar/step/motion.hpp"
#include "udar/step/stages.hpp"

namespace udar {
namespace {

/// What pushes a rigid body from outside: all but gravity and damping.
struct RigidPush {
  Vec2 force{};       ///< N
  double moment = 0;  ///< N m, about the centre of mass
};

/// Forces on the nodes of a body, which are kept for their work, and their sums.
RigidPush push_of(const Model& model, State& state, Workspace& work, const RigidBody& rigid, Vec2 centre) {
  RigidPush push;
  NodeForces forces;
  work.rigid_forces.clear();
  for (std::size_t b = rigid.block_begin; b < rigid.block_end; ++b) {
    const NodeBlock& block = model.node_blocks[b];
    forces.begin(block.begin);
    add_contact_force(model, state, work, b, forces);
    add_load_force(state, work, b, forces);
    const Vec2* const external = forces.external();
    for (Index i = block.begin; i < block.end; ++i) {
      const Vec2 force = external != nullptr ? external[i - block.begin] : Vec2{};
      work.rigid_forces.push_back(force);
      push.force += force;
      push.moment += cross(place_after(state.nodes[i], state.clock.last_step) - centre, force);
    }
  }
  return push;
}

/// The rules of lanes/accelerate_block.hpp for the three numbers of a rigid body: the mean velocity of the coming step.
RigidRate next_velocity(const NodeTask& task, bool multistep, RigidMotion& motion, const RigidRate& acceleration) {
  auto& [a0, a1, a2] = motion.accelerations;
  RigidRate next;
  if (multistep) {
    const auto& done = task.done.velocity;
    if (!task.first) {
      motion.now += task.done.implicit * acceleration + done[0] * a0 + done[1] * a1 + done[2] * a2;
    }
    const auto& mean = task.coming.mean;
    next = motion.now + mean[0] * acceleration + mean[1] * a0 + mean[2] * a1;
  } else {
    next = motion.velocity + task.span * acceleration;
  }
  a2 = a1;
  a1 = a0;
  a0 = acceleration;
  return next;
}

/// Gives every node the velocity that brings it to where the body has it at the end of the coming step, and returns
/// what forces on nodes do with these velocities, W: sum of f . (v- + v+).
double carry_nodes(const Model& model, State& state, const Workspace& work, const RigidBody& rigid,
                   const RigidMotion& motion, const NodeTask& task) {
  const Clock& clock = state.clock;
  const bool multistep = !state.velocity.empty();
  const RigidRate& after = motion.velocity;
  const RigidRate& acceleration = motion.accelerations[0];
  const Vec2 centre = motion.place + clock.next_step * after.linear;
  const Turn turn = turn_by(motion.angle + clock.next_step * after.angular);
  const Body& body = model.bodies[rigid.body];
  double power = 0;
  for (Index i = body.node_begin; i < body.node_end; ++i) {
    NodeRecord& r = state.nodes[i];
    const Vec2 place = place_after(r, clock.last_step);
    const Vec2 before{r.vx, r.vy};
    const Vec2 target = centre + turn * (model.rest[i] - rigid.centre);
    const Vec2 v = (1 / clock.next_step) * (target - place);
    r = {place.x, place.y, v.x, v.y};
    power += dot(work.rigid_forces[i - body.node_begin], before + v);
    if (multistep) {
      const Vec2 arm = place - motion.place;
      const double w = motion.now.angular;
      state.velocity[i] = motion.now.linear + w * perpendicular(arm);
      state.velocity_before[i] = before;
      state.acceleration[i] = acceleration.linear + acceleration.angular * perpendicular(arm) - (w * w) * arm;
    } else {
      state.acceleration[i] = (1 / task.span) * (v - before);
    }
  }
  return power;
}

void move(const Model& model, State& state, Workspace& work, const RigidBody& rigid, RigidMotion& motion,
          const NodeTask& task) {
  const bool multistep = !state.velocity.empty();
  const RigidRate before = motion.velocity;
  motion.place += task.last_step * before.linear;
  motion.angle += task.last_step * before.angular;
  const RigidPush push = push_of(model, state, work, rigid, motion.place);

  RigidRate damping;  // N and N m
  if (task.damping > 0) {
    damping.linear = (-task.damping * rigid.mass) * (before.linear - damping_reference(model, state, rigid.body));
    damping.angular = -task.damping * rigid.inertia * before.angular;
  }
  const RigidRate acceleration{(1 / rigid.mass) * (push.force + damping.linear) + model.run.gravity,
                               (push.moment + damping.angular) / rigid.inertia};
  const RigidRate after = next_velocity(task, multistep, motion, acceleration);
  motion.velocity = after;
  const double power_on_nodes = carry_nodes(model, state, work, rigid, motion, task);

  // Nodes go along chords of their circles. What that changes in the work of their forces is that of the forces which
  // hold the body together; it falls with the square of the step.
  const double power = dot(push.force, before.linear + after.linear) + push.moment * (before.angular + after.angular);
  const auto twice_energy = [&](const RigidRate& a, const RigidRate& b) {
    return rigid.mass * dot(a.linear, b.linear) + rigid.inertia * a.angular * b.angular;
  };
  const auto spin = [&](const RigidRate& v) {
    return rigid.mass * cross(motion.place, v.linear) + rigid.inertia * v.angular;
  };
  NodeSums& sums = work.node_sums[rigid.block_begin];
  sums = {.internal_power = power - power_on_nodes,
          .kinetic = multistep ? twice_energy(motion.now, motion.now) : twice_energy(before, after),
          .kinetic_after = twice_energy(after, after),
          .damping_before = dot(damping.linear, before.linear) + damping.angular * before.angular,
          .damping_after = dot(damping.linear, after.linear) + damping.angular * after.angular,
          .spin_after = spin(after),
          .spin = multistep ? spin(motion.now) : 0,
          .position = rigid.mass * motion.place,
          .force = push.force + damping.linear,
          .carried = rigid.mass * after.linear,
          .momentum = multistep ? rigid.mass * motion.now.linear : Vec2{},
          .damping_force = damping.linear,
          .damping_moment = cross(motion.place, damping.linear) + damping.angular};
}

}  // namespace

void move_rigid_bodies(const Model& model, State& state, Workspace& work) {
  if (model.rigid_bodies.empty()) return;
  const NodeTask task = node_task(model, state);
  for (std::size_t k = 0; k < model.rigid_bodies.size(); ++k) {
    const RigidBody& rigid = model.rigid_bodies[k];
    move(model, state, work, rigid, state.rigid[k], task);
    for (std::size_t b = rigid.block_begin; b < rigid.block_end; ++b) note_outer_nodes(model, state, work, b);
  }
}

}  // namespace udar
