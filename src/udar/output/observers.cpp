#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "udar/output/observer.hpp"

namespace udar {
namespace {

const ObserverWindow always{0, std::numeric_limits<double>::infinity()};

/// Nodes taken together, at t_n.
struct Together {
  Vec2 position{};      // m, of the centre of mass
  Vec2 momentum{};      // kg m/s
  Vec2 acceleration{};  // m/s2
  double spin = 0;      // kg m2/s, about the centre of mass
};

Together together(const BodySums& sums, double mass) {
  const Vec2 centre = (1 / mass) * sums.position;
  return {centre, sums.momentum, (1 / mass) * sums.force, sums.spin - cross(centre, sums.momentum)};
}

BodySums sum_nodes(const Model& model, const State& state, const std::vector<Index>& nodes) {
  BodySums sums;
  for (const Index i : nodes) {
    const Vec2 x = place(state, i);
    const Vec2 p = model.mass[i] * velocity(state, i);
    sums.position += model.mass[i] * x;
    sums.momentum += p;
    sums.force += model.mass[i] * state.acceleration[i];
    sums.spin += cross(x, p);
  }
  return sums;
}

const std::vector<Column> together_columns{
    {"position_x", "m"},      {"position_y", "m"},         {"velocity_x", "m/s"},
    {"velocity_y", "m/s"},    {"acceleration_x", "m/s^2"}, {"acceleration_y", "m/s^2"},
    {"momentum_x", "kg m/s"}, {"momentum_y", "kg m/s"},    {"spin", "kg m^2/s"}};

void fill(const Together& sum, double mass, std::span<double> out) {
  const Vec2 v = (1 / mass) * sum.momentum;
  const std::array values{sum.position.x, sum.position.y, v.x,     v.y, sum.acceleration.x, sum.acceleration.y,
                          sum.momentum.x, sum.momentum.y, sum.spin};
  std::copy(values.begin(), values.end(), out.begin());
}

/// A body and an obstacle may have one name, files and names of the summary may not: the later one gets a number.
void tell_apart(std::vector<Observer>& observers) {
  std::set<std::string> taken;
  for (Observer& o : observers) {
    const std::string given = o.name;
    for (int k = 2; !taken.insert(o.name).second; ++k) o.name = fmt::format("{}_{}", given, k);
  }
}

}  // namespace

Observer observe_node(const Model& model, const NodeObserver& node) {
  return {node.name,
          {{"displacement_x", "m"},
           {"displacement_y", "m"},
           {"velocity_x", "m/s"},
           {"velocity_y", "m/s"},
           {"acceleration_x", "m/s^2"},
           {"acceleration_y", "m/s^2"}},
          node.window,
          [rest = model.rest[node.node], i = node.node](const State& state, std::span<double> out) {
            const Vec2 u = place(state, i) - rest;
            const Vec2 v = velocity(state, i);
            const Vec2 a = state.acceleration[i];
            const std::array values{u.x, u.y, v.x, v.y, a.x, a.y};
            std::copy(values.begin(), values.end(), out.begin());
          }};
}

Observer observe_element(const Model&, const ElementObserver& element) {
  return {element.name,
          {{"stress_x", "Pa"},
           {"stress_y", "Pa"},
           {"stress_xy", "Pa"},
           {"stress_z", "Pa"},
           {"principal_1", "Pa"},
           {"principal_2", "Pa"},
           {"principal_3", "Pa"},
           {"max_shear", "Pa"},
           {"plastic_strain", ""},
           {"flows", ""}},
          element.window,
          [e = element.element](const State& state, std::span<double> out) {
            const auto p = principal_stresses(state, e);
            const std::array values{state.stress_xx[e],
                                    state.stress_yy[e],
                                    state.stress_xy[e],
                                    state.stress_zz[e],
                                    p[0],
                                    p[1],
                                    p[2],
                                    0.5 * (p[0] - p[2]),
                                    state.plastic_strain[e],
                                    flows(state, e) ? 1.0 : 0.0};
            std::copy(values.begin(), values.end(), out.begin());
          }};
}

namespace {

Observer observe_rigid_body(const Body& body, std::size_t number, std::size_t rigid) {
  std::vector<Column> columns = together_columns;
  columns.insert(columns.end(), {{"angle", "rad"}, {"angular_velocity", "rad/s"}});
  return {body.name, columns, always, [&body, number, rigid](const State& state, std::span<double> out) {
            fill(together(state.body_sums[number], body.mass), body.mass, out);
            out[together_columns.size()] = state.rigid[rigid].angle;
            out[together_columns.size() + 1] = velocity(state, state.rigid[rigid]).angular;
          }};
}

/// What a book of contact says, in the columns of contact_columns.
const std::vector<Column> contact_columns{
    {"force_x", "N"}, {"force_y", "N"}, {"impulse_x", "N s"}, {"impulse_y", "N s"}, {"touching_nodes", ""}};

void fill(const ContactBook& book, std::span<double> out) {
  const Vec2 impulse = book.total.impulse();
  const std::array values{book.total.force.x, book.total.force.y, impulse.x, impulse.y,
                          static_cast<double>(book.touching)};
  std::copy(values.begin(), values.end(), out.begin());
}

/// Are there few enough bodies to watch each pair?
bool few_bodies(const Model& model) { return model.bodies.size() <= 3; }

}  // namespace

Observer observe_region(const Model& model, const RegionObserver& region) {
  return {region.name, together_columns, region.window, [&model, &region](const State& state, std::span<double> out) {
            fill(together(sum_nodes(model, state, region.nodes), region.mass), region.mass, out);
          }};
}

Observer observe_body(const Model& model, std::size_t number) {
  const Body& body = model.bodies[number];
  for (std::size_t k = 0; k < model.rigid_bodies.size(); ++k) {
    if (model.rigid_bodies[k].body == number) return observe_rigid_body(body, number, k);
  }
  return {body.name, together_columns, always, [&body, number](const State& state, std::span<double> out) {
            fill(together(state.body_sums[number], body.mass), body.mass, out);
          }};
}

Observer observe_obstacle(const Model& model, std::size_t obstacle) {
  return {model.obstacles[obstacle].name, contact_columns, always,
          [obstacle](const State& state, std::span<double> out) { fill(state.obstacles[obstacle], out); }};
}

Observer observe_pair(const Model& model, Index first, Index second) {
  return {model.bodies[first].name + "-" + model.bodies[second].name, contact_columns, always,
          [first, second](const State& state, std::span<double> out) {
            const ContactBook* const book = book_of_pair(state, first, second);
            fill(book != nullptr ? *book : ContactBook{}, out);
          }};
}

Observer observe_support(const Model& model, std::size_t support) {
  std::size_t first = 0;
  for (std::size_t s = 0; s < support; ++s) first += model.supports[s].nodes.size();
  return {model.supports[support].name,
          {{"reaction_x", "N"}, {"reaction_y", "N"}, {"moment", "N m"}},
          always,
          [&held = model.supports[support], first](const State& state, std::span<double> out) {
            Vec2 sum;
            double moment = 0;
            for (std::size_t k = 0; k < held.nodes.size(); ++k) {
              const Vec2 force = state.support_forces[first + k];
              sum += force;
              moment += cross(place(state, held.nodes[k]) - held.centre, force);
            }
            out[0] = sum.x;
            out[1] = sum.y;
            out[2] = moment;
          }};
}

std::vector<Observer> make_observers(const Model& model) {
  std::vector<Observer> all{observe_energy(model), observe_momentum(model)};
  for (const NodeObserver& node : model.observed_nodes) all.push_back(observe_node(model, node));
  for (const ElementObserver& element : model.observed_elements) all.push_back(observe_element(model, element));
  for (const RegionObserver& region : model.observed_regions) all.push_back(observe_region(model, region));
  for (std::size_t b = 0; b < model.bodies.size(); ++b) all.push_back(observe_body(model, b));
  for (std::size_t o = 0; o < model.obstacles.size(); ++o) all.push_back(observe_obstacle(model, o));
  for (Index second = 0; few_bodies(model) && second < model.bodies.size(); ++second) {
    for (Index first = 0; first < second; ++first) all.push_back(observe_pair(model, first, second));
  }
  for (const BodyPairs::Exception& pair : model.body_pairs.exceptions) {
    if (!few_bodies(model) && pair.first != pair.second) all.push_back(observe_pair(model, pair.first, pair.second));
  }
  for (std::size_t s = 0; s < model.supports.size(); ++s) all.push_back(observe_support(model, s));
  tell_apart(all);
  return all;
}

}  // namespace udar
