#include "udar/study/projection.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "udar/base/error.hpp"
#include "udar/study/find_triangle.hpp"

namespace udar {
namespace {

/// A side of one triangle.
struct Half {
  std::int32_t a = 0;  ///< node; below b
  std::int32_t b = 0;
  std::uint32_t triangle = 0;
  std::uint32_t corner = 0;  ///< where it begins

  friend bool operator<(const Half& x, const Half& y) {
    return std::tie(x.a, x.b, x.triangle) < std::tie(y.a, y.b, y.triangle);
  }
};

double area_of(const std::array<Vec2, 3>& t) { return 0.5 * std::fabs(twice_area(t[0], t[1], t[2])); }

/// The sides of all triangles, those with the same nodes beside each other.
std::vector<Half> sorted_sides(const BodyMesh& mesh) {
  std::vector<Half> sides;
  sides.reserve(3 * mesh.nodes.size());
  for (std::uint32_t t = 0; t < mesh.nodes.size(); ++t) {
    for (std::uint32_t c = 0; c < 3; ++c) {
      const auto [a, b] = std::minmax(mesh.nodes[t][c], mesh.nodes[t][(c + 1) % 3]);
      sides.push_back({a, b, t, c});
    }
  }
  std::sort(sides.begin(), sides.end());
  return sides;
}

/// The same triangles in the same order, as runs of one mesh with other time steps have them.
bool same_triangles(const BodyMesh& coarse, const BodyMesh& fine, double blur) {
  const auto near = [blur](Vec2 a, Vec2 b) { return length(a - b) <= blur; };
  return std::equal(coarse.corners.begin(), coarse.corners.end(), fine.corners.begin(), fine.corners.end(),
                    [&](const auto& a, const auto& b) { return std::equal(a.begin(), a.end(), b.begin(), near); });
}

/// What of the coarse mesh lies under the fine one, found by place.
class ByPlace {
 public:
  ByPlace(const BodyMesh& coarse, const BodyMesh& fine, double blur)
      : coarse_(coarse), fine_(fine), finder_(coarse.corners, blur) {}

  void find(std::size_t triangle, Projection::Element& element) const {
    const auto& [a, b, c] = fine_.corners[triangle];
    const TriangleAt at = finder_.find(1.0 / 3 * (a + b + c));
    element.coarse = coarse_.numbers[static_cast<std::size_t>(at.triangle)];
    element.outside = at.outside;
  }
  void find(const Half& half, Projection::Side& side) const {
    const std::array<Vec2, 3>& corners = fine_.corners[half.triangle];
    const TriangleAt at = finder_.find(0.5 * (corners[half.corner] + corners[(half.corner + 1) % 3]));
    side.coarse = coarse_.nodes[static_cast<std::size_t>(at.triangle)];
    side.weights = at.weights;
    side.outside = at.outside;
  }

 private:
  const BodyMesh& coarse_;
  const BodyMesh& fine_;
  TriangleFinder finder_;
};

/// The same where the meshes have the same triangles: numbers are enough, and weights are exact.
class ByNumber {
 public:
  explicit ByNumber(const BodyMesh& coarse) : coarse_(coarse) {}

  void find(std::size_t triangle, Projection::Element& element) const { element.coarse = coarse_.numbers[triangle]; }
  void find(const Half& half, Projection::Side& side) const {
    side.coarse = coarse_.nodes[half.triangle];
    side.weights[half.corner] = 0.5;
    side.weights[(half.corner + 1) % 3] = 0.5;
  }

 private:
  const BodyMesh& coarse_;
};

template <class Way>
Projection project_by(const Way& way, const BodyMesh& fine) {
  Projection out;
  out.elements.resize(fine.nodes.size());
  for (std::size_t t = 0; t < fine.nodes.size(); ++t) {
    out.elements[t].area = area_of(fine.corners[t]);
    out.elements[t].fine = fine.numbers[t];
    way.find(t, out.elements[t]);
  }
  const std::vector<Half> halves = sorted_sides(fine);
  for (std::size_t k = 0; k < halves.size(); ++k) {
    const Half& half = halves[k];
    if (k == 0 || half.a != halves[k - 1].a || half.b != halves[k - 1].b) {
      Projection::Side& side = out.sides.emplace_back();
      side.fine = {half.a, half.b};
      way.find(half, side);
    }
    out.sides.back().area += area_of(fine.corners[half.triangle]) / 3;
  }
  return out;
}

}  // namespace

Projection project(const BodyMesh& coarse, const BodyMesh& fine, double blur) {
  const auto flat = [](const BodyMesh& mesh) {
    return std::all_of(mesh.corners.begin(), mesh.corners.end(), [](const auto& t) { return !(area_of(t) > 0); });
  };
  if (flat(coarse) || flat(fine)) throw OutputError("the mesh has no area");
  if (same_triangles(coarse, fine, blur)) return project_by(ByNumber(coarse), fine);
  return project_by(ByPlace(coarse, fine, blur), fine);
}

void DifferenceSums::add(double area_here, double difference_squared, double fine_squared, bool is_outside) {
  area.add(area_here);
  difference.add(area_here * difference_squared);
  size.add(area_here * fine_squared);
  max_squared = std::max(max_squared, difference_squared);
  largest_squared = std::max(largest_squared, fine_squared);
  if (is_outside) ++outside;
}

double DifferenceSums::l2() const { return std::sqrt(difference.value() / area.value()); }
double DifferenceSums::fine_l2() const { return std::sqrt(size.value() / area.value()); }

// std::max passes over what is no number; the sums do not.
double DifferenceSums::max() const { return std::isnan(l2()) ? l2() : std::sqrt(max_squared); }
double DifferenceSums::largest() const { return std::isnan(fine_l2()) ? fine_l2() : std::sqrt(largest_squared); }

void add_elements(const Projection& projection, std::span<const double> coarse, std::span<const double> fine,
                  DifferenceSums& sums) {
  for (const Projection::Element& element : projection.elements) {
    const double b = fine[static_cast<std::size_t>(element.fine)];
    const double difference = coarse[static_cast<std::size_t>(element.coarse)] - b;
    sums.add(element.area, difference * difference, b * b, element.outside);
  }
}

void add_nodes(const Projection& projection, std::size_t components, std::span<const double> coarse,
               std::span<const double> fine, DifferenceSums& sums) {
  const auto at = [components](std::span<const double> values, std::int32_t node, std::size_t component) {
    return values[components * static_cast<std::size_t>(node) + component];
  };
  for (const Projection::Side& side : projection.sides) {
    double difference_squared = 0;
    double fine_squared = 0;
    for (std::size_t c = 0; c < components; ++c) {
      double a = 0;
      for (std::size_t k = 0; k < 3; ++k) a += side.weights[k] * at(coarse, side.coarse[k], c);
      const double b = 0.5 * (at(fine, side.fine[0], c) + at(fine, side.fine[1], c));
      difference_squared += (a - b) * (a - b);
      fine_squared += b * b;
    }
    sums.add(side.area, difference_squared, fine_squared, side.outside);
  }
}

}  // namespace udar
