#include "udar/step/quad_forces.hpp"

#include <algorithm>

namespace udar {
namespace {

/// Calls f(block, node, slot) for every corner force, in the order of the quads; the slot counts from the first one of
/// the block.
template <class F>
void for_each_corner(const Model& model, F&& f) {
  for (std::size_t b = 0; b < model.element_blocks.size(); ++b) {
    const ElementBlock& block = model.element_blocks[b];
    const Index corners = block.paired ? 4 : 3;
    for (Index q = 0; q < block.quad_count(); ++q) {
      const std::uint32_t within = q % lanes % 2 * (lanes / 2) + q % lanes / 2;
      for (Index k = 0; k < corners; ++k) {
        f(b, model.quads[block.quads + q][k], q / lanes * (4 * lanes) + k * lanes + within);
      }
    }
  }
}

/// First and last element block at the nodes of a block; `first` above `last` where there is none.
struct Reach {
  std::size_t first = ~std::size_t{0};
  std::size_t last = 0;
};

std::vector<Reach> reaches(const Model& model) {
  std::vector<Reach> reach(model.node_blocks.size());
  std::vector<std::uint32_t> block_of(model.rest.size(), ~std::uint32_t{0});
  for (std::uint32_t n = 0; n < model.node_blocks.size(); ++n) {
    std::fill(block_of.begin() + model.node_blocks[n].begin, block_of.begin() + model.node_blocks[n].end, n);
  }
  for_each_corner(model, [&](std::size_t block, Index node, std::uint32_t) {
    if (block_of[node] == ~std::uint32_t{0}) return;  // padding
    Reach& r = reach[block_of[node]];
    r.first = std::min(r.first, block);
    r.last = block;
  });
  return reach;
}

}  // namespace

QuadForces::QuadForces(const Model& model, const Pool& pool)
    : element_blocks_(model.element_blocks.size()), node_blocks_(model.node_blocks) {
  plan(model, pool);
  number(model);
}

/// Which block of nodes is summed when, and where each block of elements writes: the first place that is free then.
void QuadForces::plan(const Model& model, const Pool& pool) {
  const std::vector<Reach> reach = reaches(model);
  std::vector<std::size_t> needed_until(element_blocks_);  // one beyond the element block after which it is summed
  for (std::size_t n = 0; n < reach.size(); ++n) {
    const auto [first, last] = reach[n];
    if (first > last) continue;  // of a rigid body
    const bool early = first <= last && pool.run_of(element_blocks_, first) == pool.run_of(element_blocks_, last);
    if (early) {
      early_.push_back({last, n});
    } else {
      late_.push_back(n);
    }
    for (std::size_t b = first; b <= last; ++b) {
      needed_until[b] = std::max(needed_until[b], early ? last + 1 : element_blocks_ + 1);
    }
  }
  std::stable_sort(early_.begin(), early_.end(), [](const Early& a, const Early& b) { return a.after < b.after; });

  // Runs are done side by side: each has places of its own.
  place_.resize(element_blocks_);
  std::vector<std::size_t> busy_until;
  std::size_t first_place = 0;
  for (std::size_t b = 0; b < element_blocks_; ++b) {
    if (b > 0 && pool.run_of(element_blocks_, b) != pool.run_of(element_blocks_, b - 1)) {
      first_place = busy_until.size();
    }
    std::size_t place = first_place;
    while (place < busy_until.size() && busy_until[place] > b) ++place;
    if (place == busy_until.size()) busy_until.push_back(0);
    busy_until[place] = std::max(needed_until[b], b + 1);
    place_[b] = place;
  }
  forces_.resize(forces_per_block * busy_until.size());
}

void QuadForces::number(const Model& model) {
  offsets_.assign(model.rest.size() + 1, 0);
  for_each_corner(model, [&](std::size_t, Index node, std::uint32_t) { ++offsets_[node + 1]; });
  for (std::size_t i = 1; i < offsets_.size(); ++i) offsets_[i] += offsets_[i - 1];
  slots_.resize(offsets_.back());
  std::vector<std::uint32_t> next(offsets_.begin(), offsets_.end() - 1);
  for_each_corner(model, [&](std::size_t block, Index node, std::uint32_t slot) {
    slots_[next[node]++] = static_cast<std::uint32_t>(forces_per_block * place_[block]) + slot;
  });
}

std::size_t QuadForces::first_done_after(std::size_t block) const {
  const auto found =
      std::lower_bound(early_.begin(), early_.end(), block, [](const Early& e, std::size_t b) { return e.after < b; });
  return static_cast<std::size_t>(found - early_.begin());
}

void QuadForces::sum(std::size_t node_block, NodeForces& forces) const {
  using Two = double __attribute__((vector_size(16)));
  const auto force = [corners = forces_.data()](std::uint32_t slot) {
    Two f;
    __builtin_memcpy(&f, &corners[slot].x, sizeof f);
    return f;
  };
  const NodeBlock block = node_blocks_[node_block];
  forces.begin(block.begin);
  Vec2* to = forces.internal;
  const std::uint32_t* const slots = slots_.data();
  const std::uint32_t* offset = offsets_.data() + block.begin;
  const std::uint32_t* slot = slots + *offset;
  for (Index i = block.begin; i < block.end; ++i, ++to) {
    const std::uint32_t* const end = slots + *++offset;
    Two total{};
    if (end - slot == 4) {  // by far the most
      total = ((force(slot[0]) + force(slot[1])) + force(slot[2])) + force(slot[3]);
      slot = end;
    }
    for (; slot != end; ++slot) total += force(*slot);
    __builtin_memcpy(&to->x, &total, sizeof total);
  }
}

}  // namespace udar
