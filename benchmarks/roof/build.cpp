#include <algorithm>
#include <cstdint>

#include "beam.hpp"

namespace roof {
namespace {

constexpr Index none = ~Index{0};

/// Two triangles (a, b, c) and (a, d, b), both counter-clockwise.
struct Pair {
  Index a, b, c, d;
};

/// Cells column by column, cut alternately as in the case. A cell is a pair whose shared edge is the diagonal.
std::vector<Pair> cut_cells(Index columns, Index rows) {
  std::vector<Pair> pairs;
  for (Index i = 0; i < columns; ++i) {
    for (Index j = 0; j < rows; ++j) {
      const Index p = i * (rows + 1) + j;
      const Index q = p + rows + 1;
      if ((i + j) % 2 == 0) {
        pairs.push_back({p, q + 1, p + 1, q});
      } else {
        pairs.push_back({q, p + 1, p, q + 1});
      }
    }
  }
  return pairs;
}

/// Pairs of a group stand side by side, so that a register can be filled from one corner of all of them.
Array<Index> interleave(const std::vector<Pair>& pairs, Index lanes) {
  Array<Index> corners;
  for (std::size_t group = 0; group < pairs.size(); group += lanes) {
    for (Index Pair::*corner : {&Pair::a, &Pair::b, &Pair::c, &Pair::d}) {
      for (Index lane = 0; lane < lanes; ++lane) corners.push_back(pairs[group + lane].*corner);
    }
  }
  return corners;
}

/// First and last group at a node.
struct Use {
  Index first = none;
  Index last = 0;
};

std::vector<Use> uses(const Problem& p, Index corners_per_group) {
  std::vector<Use> use(p.node_count);
  for (std::size_t k = 0; k < p.corners.size(); ++k) {
    if (p.corners[k] >= p.node_count) continue;
    Use& u = use[p.corners[k]];
    const Index group = static_cast<Index>(k) / corners_per_group;
    u.first = std::min(u.first, group);
    u.last = std::max(u.last, group);
  }
  return use;
}

/// Element groups begin to end of a thread, cut into stretches; fused with the nodes from `node` on that are complete
/// after each. Returns the first node that is not.
Index cut_stretches(Share& share, const std::vector<Use>& use, Index begin, Index end, Index per_stretch, Index node,
                    bool fused) {
  for (Index g = begin; g < end; g += per_stretch) {
    Stretch s{.group_begin = g, .group_end = std::min(g + per_stretch, end), .node_begin = node, .node_end = node};
    while (fused && s.node_end < use.size() && use[s.node_end].last < s.group_end) ++s.node_end;
    node = s.node_end;
    share.stretches.push_back(s);
  }
  return node;
}

/// Which groups and nodes each thread takes. Fused, a node with groups of two threads is summed late, by the second.
void share_out(Problem& p, const std::vector<Use>& use, Index groups, Index per_stretch) {
  const auto threads = static_cast<Index>(p.settings.threads);
  const bool fused = p.settings.variant == Variant::fused;
  const auto part = [&](Index count, Index t) { return static_cast<Index>(std::uint64_t{count} * t / threads); };
  Index node = 0;
  for (Index t = 0; t < threads; ++t) {
    Share share;
    const Index begin = part(groups, t);
    share.late.node_begin = fused ? node : part(p.node_count, t);
    while (fused && node < p.node_count && use[node].first < begin) ++node;
    share.late.node_end = fused ? node : part(p.node_count, t + 1);
    node = cut_stretches(share, use, begin, part(groups, t + 1), per_stretch, node, fused);
    p.shares.push_back(share);
  }
}

/// Groups whose forces must last until after the barrier.
std::vector<bool> kept_groups(const Problem& p, Index groups, Index per_group) {
  std::vector<bool> kept(groups);
  for (std::size_t k = 0; k < p.corners.size(); ++k) {
    for (const Share& share : p.shares) {
      if (p.corners[k] >= share.late.node_begin && p.corners[k] < share.late.node_end) kept[k / per_group] = true;
    }
  }
  return kept;
}

/// Where each group leaves its forces. Fused, a thread uses the same few places over and over, and they stay in the
/// cache.
void place_forces(Problem& p, const std::vector<Use>& use, Index groups, Index per_group, Index per_stretch) {
  const std::vector<bool> kept = kept_groups(p, groups, per_group);
  Index longest = 0;
  for (const Use& u : use) longest = std::max(longest, u.last - u.first);
  const Index ring = longest + 2 * per_stretch;
  p.base.resize(groups);
  Index place = 0;
  for (const Share& share : p.shares) {
    const Index ring_begin = place;
    place += ring;
    for (Index g = share.stretches.front().group_begin; g < share.stretches.back().group_end; ++g) {
      p.base[g] = (kept[g] ? place++ : ring_begin + g % ring) * per_group;
    }
  }
  p.forces.resize(std::size_t{place} * per_group);
}

void add_runs(Problem& p, const std::vector<Index>& begin, Stretch& stretch) {
  stretch.run_begin = static_cast<Index>(p.runs.size());
  for (Index n = stretch.node_begin; n < stretch.node_end;) {
    Run run{n, n, begin[n + 1] - begin[n], begin[n]};
    while (run.end < stretch.node_end && begin[run.end + 1] - begin[run.end] == run.forces) ++run.end;
    p.runs.push_back(run);
    n = run.end;
  }
  stretch.run_end = static_cast<Index>(p.runs.size());
}

/// Every node's forces, in the order of groups; a node at the bottom has one more, of the stop.
void list_slots(Problem& p, const std::vector<Index>& slot_of_lane) {
  const auto lanes = static_cast<Index>(slot_of_lane.size());
  const auto fill = [&](auto&& put) {
    for (std::size_t k = 0; k < p.corners.size(); ++k) {
      if (p.corners[k] >= p.node_count) continue;
      const std::size_t group = k / (4 * lanes), corner = k / lanes % 4;
      put(p.corners[k], static_cast<Index>(p.base[group] + corner * lanes + slot_of_lane[k % lanes]));
    }
    for (const WallNode& w : p.wall) put(w.node, w.slot);
  };
  std::vector<Index> begin(p.node_count + 1);
  fill([&](Index node, Index) { ++begin[node + 1]; });
  for (Index n = 0; n < p.node_count; ++n) begin[n + 1] += begin[n];
  p.slots.resize(begin.back());
  std::vector<Index> next(begin.begin(), begin.end() - 1);
  fill([&](Index node, Index slot) { p.slots[next[node]++] = slot * static_cast<Index>(sizeof(Force)); });
  for (Share& share : p.shares) {
    add_runs(p, begin, share.late);
    for (Stretch& stretch : share.stretches) add_runs(p, begin, stretch);
  }
}

/// The nodes at the bottom, each pushed by the thread that moves it.
void add_wall(Problem& p, Index columns, Index rows) {
  const auto first = static_cast<Index>(p.forces.size());
  for (Index i = 0; i <= columns; ++i) p.wall.push_back({.node = i * (rows + 1), .slot = first + i});
  p.forces.resize(p.forces.size() + p.wall.size());
  const auto count_below = [&](Index node) { return (node + rows) / (rows + 1); };
  for (Share& share : p.shares) {
    share.wall_begin = count_below(share.late.node_begin);
    share.wall_end = count_below(std::max(share.late.node_end, share.stretches.back().node_end));
  }
}

void add_masses(Problem& p, const std::vector<Pair>& pairs) {
  std::vector<double> mass(p.node_count);
  const double third = p.beam.density * p.beam.thickness * 0.5 * p.cell * p.cell / 3;
  for (const Pair& pair : pairs) {
    if (pair.a >= p.node_count) continue;
    mass[pair.a] += 2 * third;
    mass[pair.b] += 2 * third;
    mass[pair.c] += third;
    mass[pair.d] += third;
  }
  for (const double m : mass) p.kick.push_back(p.step * 0.5 * p.beam.thickness / m);
}

constexpr double step_per_metre = 1.28e-7 / 0.0025;  // twice the paper's step, two thirds of the stable one

}  // namespace

void restart(Problem& p) {
  const Index rows = p.settings.columns / 4;
  const double velocity = -p.beam.speed - 0.5 * p.step * p.beam.gravity;
  for (Index i = 0; i <= p.settings.columns; ++i) {
    for (Index j = 0; j <= rows; ++j) {
      p.nodes[i * (rows + 1) + j] = {-0.5 * p.beam.length + i * p.cell, j * p.cell + p.step * velocity, 0, velocity};
    }
  }
  std::fill(p.stress.begin(), p.stress.end(), Line{});
  for (WallNode& w : p.wall) w.face = 0;
}

Problem build(const Settings& settings, const std::vector<Index>& slot_of_lane) {
  const auto lanes = static_cast<Index>(slot_of_lane.size());
  const Index columns = settings.columns, rows = columns / 4;
  std::vector<Pair> pairs = cut_cells(columns, rows);
  Problem p;
  p.settings = settings;
  p.elements = static_cast<Index>(2 * pairs.size());
  p.node_count = (columns + 1) * (rows + 1);
  p.cell = p.beam.length / columns;
  p.step = step_per_metre * p.cell;
  while (pairs.size() % lanes != 0) {
    const Index n = p.node_count;
    pairs.push_back({n, n + 1, n + 2, n + 3});
  }
  p.corners = interleave(pairs, lanes);
  const auto groups = static_cast<Index>(pairs.size() / lanes);
  const Index per_stretch = pairs_per_stretch / lanes;
  const std::vector<Use> use = uses(p, 4 * lanes);
  share_out(p, use, groups, per_stretch);
  place_forces(p, use, groups, 4 * lanes, per_stretch);
  add_wall(p, columns, rows);
  list_slots(p, slot_of_lane);
  add_masses(p, pairs);
  for (Index& corner : p.corners) corner *= sizeof(Node);
  p.stress.resize(std::size_t{groups} * lanes);
  p.nodes.assign(p.node_count, {});
  for (const Node& n : {Node{0, 0, 0, 0}, {1, 1, 0, 0}, {0, 1, 0, 0}, {1, 0, 0, 0}}) p.nodes.push_back(n);
  restart(p);
  return p;
}

}  // namespace roof
