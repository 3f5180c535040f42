#include "udar/study/find_triangle.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "udar/base/error.hpp"

namespace udar {
namespace {

using Corners = TriangleFinder::Corners;

double twice_area_of(const Corners& t) { return twice_area(t[0], t[1], t[2]); }

std::array<double, 3> weights_at(const Corners& t, Vec2 p) {
  const double whole = twice_area_of(t);
  const double second = twice_area(t[0], p, t[2]) / whole;
  const double third = twice_area(t[0], t[1], p) / whole;
  return {1 - second - third, second, third};
}

/// Square of the distance to the side from a to b, m2.
double distance_squared(Vec2 p, Vec2 a, Vec2 b) {
  const Vec2 side = b - a;
  const double along = std::clamp(dot(p - a, side) / dot(side, side), 0.0, 1.0);
  const Vec2 apart = p - (a + along * side);
  return dot(apart, apart);
}

/// The same of a point outside.
double distance_squared(Vec2 p, const Corners& t) {
  return std::min({distance_squared(p, t[0], t[1]), distance_squared(p, t[1], t[2]), distance_squared(p, t[2], t[0])});
}

/// Number of the bin at a distance from the first one's edge.
std::int32_t bin_at(double distance, double size, std::int32_t count) {
  if (!(distance > 0)) return 0;
  return static_cast<std::int32_t>(std::min(distance / size, static_cast<double>(count - 1)));
}

}  // namespace

TriangleFinder::TriangleFinder(std::vector<Corners> triangles, double blur)
    : triangles_(std::move(triangles)), blur_(blur) {
  double area = 0;
  for (const Corners& t : triangles_) {
    for (const Vec2 p : t) {
      if (!std::isfinite(p.x) || !std::isfinite(p.y)) throw OutputError("a node of the mesh has no place");
      box_.include(p);
    }
    area = std::max(area, std::fabs(twice_area_of(t)));
  }
  if (!(area > 0)) throw OutputError("the mesh has no area");
  box_ = box_.grown(blur);
  make_bins();
  fill_bins();
}

/// About as many bins as triangles, as square as they can be.
void TriangleFinder::make_bins() {
  const auto count = static_cast<double>(triangles_.size());
  const Vec2 size = box_.size();
  const auto whole = [count](double x) { return static_cast<std::int32_t>(std::clamp(std::floor(x), 1.0, count)); };
  columns_ = whole(std::sqrt(count * size.x / size.y));
  rows_ = whole(count / columns_);
  bin_size_ = {size.x / columns_, size.y / rows_};
}

void TriangleFinder::fill_bins() {
  const auto for_each_bin = [this](std::size_t number, auto visit) {
    if (twice_area_of(triangles_[number]) == 0) return;
    const Box around = bounding_box(triangles_[number]).grown(blur_);
    for (std::int32_t j = row(around.low.y); j <= row(around.high.y); ++j) {
      for (std::int32_t i = column(around.low.x); i <= column(around.high.x); ++i) {
        visit(static_cast<std::size_t>(j) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(i));
      }
    }
  };
  begins_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_) + 1, 0);
  for (std::size_t t = 0; t < triangles_.size(); ++t) for_each_bin(t, [this](std::size_t bin) { ++begins_[bin + 1]; });
  for (std::size_t bin = 1; bin < begins_.size(); ++bin) begins_[bin] += begins_[bin - 1];
  members_.resize(begins_.back());
  std::vector<std::size_t> next(begins_.begin(), begins_.end() - 1);
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    for_each_bin(t, [&](std::size_t bin) { members_[next[bin]++] = static_cast<std::int32_t>(t); });
  }
}

std::int32_t TriangleFinder::column(double x) const { return bin_at(x - box_.low.x, bin_size_.x, columns_); }
std::int32_t TriangleFinder::row(double y) const { return bin_at(y - box_.low.y, bin_size_.y, rows_); }

/// A weight is the distance from a side over the height on that side. The box's sides stand for the longest side, at
/// most 1.42 times too long.
bool TriangleFinder::holds(std::int32_t triangle, Vec2 point) const {
  const Corners& t = triangles_[static_cast<std::size_t>(triangle)];
  const Vec2 size = bounding_box(t).size();
  const double least = -blur_ * (size.x + size.y) / std::fabs(twice_area_of(t));
  const std::array<double, 3> weights = weights_at(t, point);
  return weights[0] >= least && weights[1] >= least && weights[2] >= least;
}

template <class Visit>
void TriangleFinder::for_each_in(std::int32_t i, std::int32_t j, Visit visit) const {
  const std::size_t bin =
      static_cast<std::size_t>(j) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(i);
  for (std::size_t k = begins_[bin]; k < begins_[bin + 1]; ++k) visit(members_[k]);
}

/// All triangles of the bins that are `ring` steps away in one direction and no more in the other.
template <class Visit>
void TriangleFinder::for_each_in_ring(std::int32_t i, std::int32_t j, std::int32_t ring, Visit visit) const {
  for (std::int32_t y = std::max(0, j - ring); y <= std::min(rows_ - 1, j + ring); ++y) {
    const bool whole_row = y == j - ring || y == j + ring;
    const std::int32_t step = whole_row || ring == 0 ? 1 : 2 * ring;
    for (std::int32_t x = i - ring; x <= i + ring; x += step) {
      if (x >= 0 && x < columns_) for_each_in(x, y, visit);
    }
  }
}

TriangleAt TriangleFinder::find(Vec2 point) const {
  TriangleAt found;
  if (box_.holds(point)) {
    for_each_in(column(point.x), row(point.y), [&](std::int32_t t) {
      if (found.triangle < 0 && holds(t, point)) found.triangle = t;
    });
  }
  if (found.triangle < 0) {
    found.triangle = nearest(point);
    found.outside = true;
  }
  found.weights = weights_at(triangles_[static_cast<std::size_t>(found.triangle)], point);
  return found;
}

/// Ring after ring of bins round the one that the point is in, or would be in if it were moved into the box. What lies
/// beyond a ring is at least that many bins from the moved point, and moving into a box never takes a point farther
/// from what is in it.
std::int32_t TriangleFinder::nearest(Vec2 point) const {
  const Vec2 moved{std::clamp(point.x, box_.low.x, box_.high.x), std::clamp(point.y, box_.low.y, box_.high.y)};
  const std::int32_t i = column(moved.x);
  const std::int32_t j = row(moved.y);
  const double bin = std::min(bin_size_.x, bin_size_.y);
  std::int32_t best = -1;
  double least = std::numeric_limits<double>::infinity();
  for (std::int32_t ring = 0; ring <= std::max(columns_, rows_); ++ring) {
    for_each_in_ring(i, j, ring, [&](std::int32_t t) {
      const double distance = distance_squared(point, triangles_[static_cast<std::size_t>(t)]);
      if (distance > least || (distance == least && t > best)) return;
      least = distance;
      best = t;
    });
    const double beyond = ring * bin;
    if (best >= 0 && dot(point - moved, point - moved) + beyond * beyond > least) break;
  }
  return best;
}

}  // namespace udar
