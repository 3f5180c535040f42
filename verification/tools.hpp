#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "run.hpp"
#include "udar/base/sym_tensor.hpp"

namespace udar::verification {

/// What the scheme itself smears: with linear elements, lumped masses and central difference the frequency of wave
/// number k is c k (1 - (1 - C^2) (k h)^2 / 24), C = c dt / h the step in cells. A jump that has run a way D is then
/// the integral of Airy's function with the length l = ((1 - C^2) h^2 D / 8)^(1/3). The automatic step is 0.9 x 0.9 x
/// 0.707 h / c or so: C = 0.6 (with nu = 0 the element factor is 1 or less).
inline double airy_length(double element_size, double way) {
  return std::cbrt((1 - 0.36) * element_size * element_size * way / 8);
}

// --- looking at a run

/// A run of a model that was changed by hand after it was built from a case.
struct ModelRun {
  explicit ModelRun(Model changed) : model(std::move(changed)), work(model, 1), state(start(model, work)) {}
  ModelRun(const ModelRun&) = delete;

  [[nodiscard]] double time() const { return state.clock.time.value(); }
  [[nodiscard]] bool done() const { return finished(model, state); }
  void step() { udar::step(model, state, work); }
  [[nodiscard]] Vec2 displacement(Index node) const {
    return Vec2{state.nodes[node].x, state.nodes[node].y} - model.rest[node];
  }

  Model model;
  Workspace work;
  State state;
};

/// A quantity against time.
struct Record {
  std::vector<double> times;
  std::vector<double> values;

  void add(double time, double value) {
    times.push_back(time);
    values.push_back(value);
  }
  /// First time at which the values pass `level` after `from`, on the straight line between two of them; -1: never.
  [[nodiscard]] double passes(double level, double from = 0) const {
    for (std::size_t i = 1; i < times.size(); ++i) {
      if (times[i] < from || (values[i - 1] < level) == (values[i] < level)) continue;
      const double t = times[i - 1] + (times[i] - times[i - 1]) * (level - values[i - 1]) / (values[i] - values[i - 1]);
      if (t >= from) return t;
    }
    return -1;
  }
  /// Time of the largest value in a window: top of the parabola through it and its neighbours (steps of equal size).
  [[nodiscard]] double peak_time(double from, double to) const {
    std::size_t top = 0;
    double largest = -1e300;
    for (std::size_t i = 1; i + 1 < times.size(); ++i) {
      if (times[i] >= from && times[i] <= to && values[i] > largest) largest = values[top = i];
    }
    const double bend = values[top - 1] - 2 * values[top] + values[top + 1];
    const double shift = 0.5 * (values[top - 1] - values[top + 1]) / bend;
    return times[top] + shift * (times[top + 1] - times[top]);
  }
  /// Mean over a window.
  [[nodiscard]] double mean(double from, double to) const {
    double sum = 0;
    double span = 0;
    for (std::size_t i = 1; i < times.size(); ++i) {
      if (times[i - 1] < from || times[i] > to) continue;
      sum += 0.5 * (values[i - 1] + values[i]) * (times[i] - times[i - 1]);
      span += times[i] - times[i - 1];
    }
    return sum / span;
  }
};

inline Index nearest(const Model& model, Vec2 place) {
  Index found = 0;
  double smallest = 1e300;
  for (Index i = 0; i < model.node_count; ++i) {
    const Vec2 d = model.rest[i] - place;
    if (dot(d, d) < smallest) {
      smallest = dot(d, d);
      found = i;
    }
  }
  return found;
}

inline Vec2 rest_centroid(const Model& model, Index element) {
  const auto& c = model.corners[element];
  return (1.0 / 3) * (model.rest[c[0]] + model.rest[c[1]] + model.rest[c[2]]);
}

inline SymTensor<double> stress_of(const State& state, Index e) {
  return {state.stress_xx[e], state.stress_yy[e], state.stress_xy[e], state.stress_zz[e]};
}

/// Nodes and their partners under a mapping of undeformed places, exact to a millionth of `size`; no partner: skipped.
/// The grid of keys is an odd one, so that no place of a round mesh lies on the line between two keys.
template <class Map>
std::vector<std::pair<Index, Index>> partners(const Model& model, double size, Map&& map) {
  const auto key = [&](Vec2 p) {
    const double grid = 0.98765432109e-6 * size;
    return std::pair{std::llround(p.x / grid + 0.123), std::llround(p.y / grid + 0.321)};
  };
  std::map<std::pair<long long, long long>, Index> places;
  for (Index i = 0; i < model.node_count; ++i) places[key(model.rest[i])] = i;
  std::vector<std::pair<Index, Index>> pairs;
  for (Index i = 0; i < model.node_count; ++i) {
    const auto found = places.find(key(map(model.rest[i])));
    if (found != places.end()) pairs.emplace_back(i, found->second);
  }
  return pairs;
}

/// How far the velocities are from a mirror symmetry: largest difference over largest velocity. The mirror line is
/// x = `line` (across_x) or y = `line`.
template <class AnyRun>
double mirror_error(const AnyRun& run, bool across_x, double line, double size) {
  const auto mirror = [&](Vec2 p) { return across_x ? Vec2{2 * line - p.x, p.y} : Vec2{p.x, 2 * line - p.y}; };
  const auto pairs = partners(run.model, size, mirror);
  if (pairs.size() != run.model.node_count) return 1e300;
  double difference = 0;
  double largest = 0;
  for (const auto& [i, j] : pairs) {
    const Vec2 a = velocity(run.state, i);
    const Vec2 b = velocity(run.state, j);
    const Vec2 image = across_x ? Vec2{-b.x, b.y} : Vec2{b.x, -b.y};
    difference = std::max(difference, length(a - image));
    largest = std::max(largest, length(a));
  }
  return difference / largest;
}

/// L2 norms over the undeformed body, by the rule of the three mid-sides (exact for parabolas) applied to each
/// triangle and, so that jumps count as well, to its `split`^2 parts.
struct Norms {
  double error = 0;
  double exact = 0;
  [[nodiscard]] double relative() const { return std::sqrt(error / exact); }
};

template <class Visit>
void for_each_quadrature_point(const Model& model, int split, Visit&& visit) {
  for (const Body& body : model.bodies) {
    for (Index e = body.element_begin; e < body.element_end; ++e) {
      const auto& c = model.corners[e];
      const Vec2 a = model.rest[c[0]];
      const Vec2 ab = model.rest[c[1]] - a;
      const Vec2 ac = model.rest[c[2]] - a;
      const double weight = 0.5 * (ab.x * ac.y - ab.y * ac.x) / (3.0 * split * split);
      const auto at = [&](double s, double t) { visit(e, a + s * ab + t * ac, std::array{1 - s - t, s, t}, weight); };
      const double d = 1.0 / split;
      for (int i = 0; i < split; ++i) {
        for (int j = 0; i + j < split; ++j) {
          const double s = i * d;
          const double t = j * d;
          at(s + d / 2, t), at(s, t + d / 2), at(s + d / 2, t + d / 2);
          if (i + j + 1 == split) continue;  // the upside-down part
          at(s + d, t + d / 2), at(s + d / 2, t + d), at(s + d / 2, t + d / 2);
        }
      }
    }
  }
}

/// Error of the displacement, linear in each triangle, against exact(place).
template <class AnyRun, class Exact>
Norms displacement_error(const AnyRun& run, Exact&& exact, int split = 1) {
  Norms norms;
  for_each_quadrature_point(run.model, split,
                            [&](Index e, Vec2 place, const std::array<double, 3>& shares, double weight) {
                              Vec2 u;
                              for (std::size_t k = 0; k < 3; ++k)
                                u += shares[k] * run.displacement(run.model.corners[e][k]);
                              const Vec2 wanted = exact(place);
                              norms.error += weight * dot(u - wanted, u - wanted);
                              norms.exact += weight * dot(wanted, wanted);
                            });
  return norms;
}

/// Error of the stress in the plane, constant in each triangle.
template <class AnyRun, class Exact>
Norms stress_error(const AnyRun& run, Exact&& exact, int split = 1) {
  const auto square = [](const SymTensor<double>& s) { return s.xx * s.xx + s.yy * s.yy + 2 * s.xy * s.xy; };
  Norms norms;
  for_each_quadrature_point(run.model, split, [&](Index e, Vec2 place, const std::array<double, 3>&, double weight) {
    const SymTensor<double> s = stress_of(run.state, e);
    const SymTensor<double> wanted = exact(place);
    norms.error += weight * square({s.xx - wanted.xx, s.yy - wanted.yy, s.xy - wanted.xy, 0});
    norms.exact += weight * square(wanted);
  });
  return norms;
}

/// Relative imbalance of momentum: change less impulses, over the sum of m |v| at the start or the largest impulse.
inline double momentum_error(const Run& run) {
  const Ledger& ledger = run.state.ledger;
  double scale = ledger.momentum_scale;
  for (const ForceBook& book : ledger.books) scale = std::max(scale, length(book.impulse()));
  return ledger.momentum_gap / scale;
}

/// Where a function changes its sign between `low` and `high`.
template <class Function>
double root_between(Function&& f, double low, double high) {
  const bool rising = f(low) < 0;
  for (int i = 0; i < 200; ++i) {
    const double mid = 0.5 * (low + high);
    ((f(mid) < 0) == rising ? low : high) = mid;
  }
  return 0.5 * (low + high);
}

}  // namespace udar::verification
