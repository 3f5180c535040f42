#include "udar/contact/search.hpp"

#include <algorithm>
#include <cmath>

#include "udar/base/box.hpp"

namespace udar {
namespace {

/// A grid of square cells over a box, as many as there are points at most: small ones where there are many.
class Grid {
 public:
  Grid(const Box& box, double smallest_cell, std::size_t most_cells) : low_(box.low) {
    const Vec2 size = box.size();
    const double by_count = std::sqrt(size.x * size.y / static_cast<double>(most_cells));
    const double by_side = std::max(size.x, size.y) / static_cast<double>(most_cells);
    cell_ = std::max({smallest_cell, by_count, by_side});
    columns_ = 1 + static_cast<std::uint32_t>(size.x / cell_);
    rows_ = 1 + static_cast<std::uint32_t>(size.y / cell_);
  }
  [[nodiscard]] std::size_t cells() const { return std::size_t{columns_} * rows_; }
  [[nodiscard]] std::uint32_t cell_of(Vec2 p) const { return row(p.y) * columns_ + column(p.x); }

  /// Calls f(cell) for all cells that the box meets.
  template <class F>
  void for_each_cell(const Box& box, F&& f) const {
    for (std::uint32_t r = row(box.low.y); r <= row(box.high.y); ++r) {
      for (std::uint32_t c = column(box.low.x); c <= column(box.high.x); ++c) f(r * columns_ + c);
    }
  }

 private:
  [[nodiscard]] std::uint32_t column(double x) const { return place(x - low_.x, columns_); }
  [[nodiscard]] std::uint32_t row(double y) const { return place(y - low_.y, rows_); }
  [[nodiscard]] std::uint32_t place(double from_low, std::uint32_t count) const {
    const double cell = from_low / cell_;
    return cell > 0 ? static_cast<std::uint32_t>(std::min(cell, static_cast<double>(count - 1))) : 0;
  }

  Vec2 low_;
  double cell_ = 0;
  std::uint32_t columns_ = 1;
  std::uint32_t rows_ = 1;
};

double distance_squared(Vec2 p, const SegmentEnds& s) {
  const Vec2 along = s.b - s.a;
  const double square = dot(along, along);
  const double part = square > 0 ? std::clamp(dot(p - s.a, along) / square, 0.0, 1.0) : 0;
  const Vec2 away = p - (s.a + part * along);
  return dot(away, away);
}

}  // namespace

Neighbours find_near(const std::vector<Vec2>& points, const std::vector<SegmentEnds>& segments, double reach) {
  Neighbours found;
  found.begin.assign(points.size() + 1, 0);
  const Box everything = bounding_box(points);
  // Where a place or the reach is not a number, nobody can say what is near. The step finds that out, too.
  const bool known = std::isfinite(length(everything.size()) + reach);
  if (points.empty() || !known) return found;
  const Grid grid(everything, reach, points.size());

  // Points by cell.
  std::vector<std::uint32_t> first(grid.cells() + 1);
  for (const Vec2 p : points) ++first[grid.cell_of(p) + 1];
  for (std::size_t c = 1; c < first.size(); ++c) first[c] += first[c - 1];
  std::vector<std::uint32_t> in_cell(points.size());
  std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
  for (std::uint32_t i = 0; i < points.size(); ++i) in_cell[next[grid.cell_of(points[i])]++] = i;

  // Segment by segment the points near it; twice, to count and to list. So each point's segments rise.
  const double reach_squared = reach * reach;
  const auto for_each_pair = [&](auto&& f) {
    for (std::uint32_t s = 0; s < segments.size(); ++s) {
      Box box;
      box.include(segments[s].a);
      box.include(segments[s].b);
      grid.for_each_cell(box.grown(reach), [&](std::uint32_t cell) {
        for (std::uint32_t k = first[cell]; k < first[cell + 1]; ++k) {
          if (distance_squared(points[in_cell[k]], segments[s]) <= reach_squared) f(in_cell[k], s);
        }
      });
    }
  };
  for_each_pair([&](std::uint32_t point, std::uint32_t) { ++found.begin[point + 1]; });
  for (std::size_t i = 1; i < found.begin.size(); ++i) found.begin[i] += found.begin[i - 1];
  found.near.resize(found.begin.back());
  next.assign(found.begin.begin(), found.begin.end() - 1);
  for_each_pair([&](std::uint32_t point, std::uint32_t s) { found.near[next[point]++] = s; });
  return found;
}

}  // namespace udar
