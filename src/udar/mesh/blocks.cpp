#include "udar/mesh/blocks.hpp"

#include <algorithm>
#include <optional>

#include "udar/mesh/neighbours.hpp"

namespace udar {
namespace {

using Triangle = std::array<Index, 3>;

/// The quad of two triangles, if they share a side.
std::optional<Quad> joined(const Triangle& one, const Triangle& two) {
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      const Index a = one[i];
      const Index b = one[(i + 1) % 3];
      if (two[j] == b && two[(j + 1) % 3] == a) return Quad{a, b, one[(i + 2) % 3], two[(j + 2) % 3]};
    }
  }
  return std::nullopt;
}

class Cutter {
 public:
  explicit Cutter(Mesh& mesh)
      : mesh_(mesh), triangles_(std::move(mesh.triangles)), numbers_(std::move(mesh.triangle_numbers)) {
    mesh.triangles.clear();
    mesh.triangle_numbers.clear();
    mesh.triangles.reserve(triangles_.size());
    mesh.triangle_numbers.reserve(triangles_.size());
    out_.quads.reserve(triangles_.size() / 2 + lanes);
  }

  MeshBlocks run() {
    const auto count = static_cast<Index>(triangles_.size());
    for (Index t = 0; t < count; ++t) {
      const auto quad = t + 1 < count ? joined(triangles_[t], triangles_[t + 1]) : std::nullopt;
      if (quad) {
        pairs_.push_back({*quad, t++});
      } else {
        singles_.push_back(t);
      }
      if (pairs_.size() == elements_per_block / 2) {
        // Single triangles are not kept waiting for long: their nodes are summed when the last element is done.
        cut_pairs(pairs_.size());
        cut_singles(singles_.size() / lanes * lanes);
      }
    }
    cut_pairs(pairs_.size() / lanes * lanes);
    for (const Pair& left : pairs_) singles_.insert(singles_.end(), {left.first, left.first + 1});
    cut_singles(singles_.size());
    return std::move(out_);
  }

 private:
  struct Pair {
    Quad quad;
    Index first;  ///< of its triangles; the other one follows
  };

  void cut_pairs(std::size_t count) {
    if (count == 0) return;
    open_block(true);
    for (std::size_t k = 0; k < count; ++k) {
      const auto& [a, b, c, d] = pairs_[k].quad;
      out_.quads.push_back(pairs_[k].quad);
      add(pairs_[k].first, {a, b, c});
    }
    for (std::size_t k = 0; k < count; ++k) {
      const auto& [a, b, c, d] = pairs_[k].quad;
      add(pairs_[k].first + 1, {a, d, b});
    }
    close_block();
    pairs_.erase(pairs_.begin(), pairs_.begin() + static_cast<std::ptrdiff_t>(count));
  }

  void cut_singles(std::size_t count) {
    for (std::size_t begin = 0; begin < count; begin += elements_per_block) {
      open_block(false);
      for (std::size_t k = begin; k < std::min<std::size_t>(count, begin + elements_per_block); ++k) {
        const auto& [a, b, c] = triangles_[singles_[k]];
        out_.quads.push_back({a, b, c, a});
        add(singles_[k], {a, b, c});
      }
      close_block();
    }
    singles_.erase(singles_.begin(), singles_.begin() + static_cast<std::ptrdiff_t>(count));
  }

  void add(Index triangle, const Triangle& corners) {
    mesh_.triangles.push_back(corners);
    mesh_.triangle_numbers.push_back(numbers_[triangle]);
  }
  void open_block(bool paired) {
    out_.blocks.push_back({.begin = static_cast<Index>(mesh_.triangles.size()),
                           .quads = static_cast<Index>(out_.quads.size()),
                           .paired = paired});
  }
  void close_block() {
    ElementBlock& block = out_.blocks.back();
    block.end = (static_cast<Index>(mesh_.triangles.size()) + lanes - 1) / lanes * lanes;
    out_.quads.resize(block.quads + block.quad_count(), {none, none, none, none});
  }

  Mesh& mesh_;
  const std::vector<Triangle> triangles_;
  const std::vector<Index> numbers_;
  std::vector<Pair> pairs_;
  std::vector<Index> singles_;
  MeshBlocks out_;
};

}  // namespace

MeshBlocks cut_blocks(Mesh& mesh) { return Cutter(mesh).run(); }

}  // namespace udar
