#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "udar/mesh/mesh.hpp"
#include "udar/study/projection.hpp"

namespace udar {

/// A mesh as the only body of a frame.
inline BodyMesh body_mesh(const Mesh& mesh) {
  BodyMesh body;
  for (const auto& triangle : mesh.triangles) {
    body.numbers.push_back(static_cast<std::int32_t>(body.nodes.size()));
    auto& nodes = body.nodes.emplace_back();
    auto& corners = body.corners.emplace_back();
    for (std::size_t c = 0; c < 3; ++c) {
      nodes[c] = static_cast<std::int32_t>(triangle[c]);
      corners[c] = mesh.nodes[triangle[c]];
    }
  }
  return body;
}

/// f at the nodes.
template <class F>
std::vector<double> at_nodes(const Mesh& mesh, F f) {
  std::vector<double> values;
  for (const Vec2 p : mesh.nodes) values.push_back(f(p));
  return values;
}

/// f at the centroids of the triangles.
template <class F>
std::vector<double> at_centroids(const Mesh& mesh, F f) {
  std::vector<double> values;
  for (const auto& [a, b, c] : mesh.triangles) {
    values.push_back(f(1.0 / 3 * (mesh.nodes[a] + mesh.nodes[b] + mesh.nodes[c])));
  }
  return values;
}

/// f sampled at the centroids of two meshes, compared.
template <class F>
DifferenceSums element_difference(const Mesh& coarse, const Mesh& fine, F f, double blur = 1e-12) {
  DifferenceSums sums;
  add_elements(project(body_mesh(coarse), body_mesh(fine), blur), at_centroids(coarse, f), at_centroids(fine, f), sums);
  return sums;
}

/// f sampled at the nodes of two meshes, compared.
template <class F>
DifferenceSums node_difference(const Mesh& coarse, const Mesh& fine, F f, double blur = 1e-12) {
  DifferenceSums sums;
  add_nodes(project(body_mesh(coarse), body_mesh(fine), blur), 1, at_nodes(coarse, f), at_nodes(fine, f), sums);
  return sums;
}

}  // namespace udar
