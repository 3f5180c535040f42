// The program's steps on a mesh that numbers its nodes and triangles at random, as a file from elsewhere may, and on
// the same mesh as generated: numbering for speed has to make them equally fast. Prints a line of JSON for each.

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <random>

#include "udar/case/build_model.hpp"
#include "udar/case/case_file.hpp"
#include "udar/step/step.hpp"

namespace {

using namespace udar;

/// Where each of so many things goes.
std::vector<Index> random_places(std::size_t count, std::mt19937& random) {
  std::vector<Index> places(count);
  std::iota(places.begin(), places.end(), Index{0});
  std::shuffle(places.begin(), places.end(), random);
  return places;
}

/// The same mesh; also each triangle begins with any of its corners.
Mesh shuffled(const Mesh& mesh) {
  std::mt19937 random(1);
  const std::vector<Index> node = random_places(mesh.nodes.size(), random);
  const std::vector<Index> triangle = random_places(mesh.triangles.size(), random);
  Mesh out = mesh;
  for (std::size_t i = 0; i < node.size(); ++i) out.nodes[node[i]] = mesh.nodes[i];
  for (std::size_t t = 0; t < triangle.size(); ++t) {
    auto& corners = out.triangles[triangle[t]];
    for (std::size_t k = 0; k < 3; ++k) corners[k] = node[mesh.triangles[t][k]];
    std::rotate(corners.begin(), corners.begin() + random() % 3, corners.end());
  }
  for (NamedEdges& side : out.sides) {
    for (Edge& edge : side.edges) edge = {node[edge.a], node[edge.b]};
  }
  return out;
}

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

void measure(const Case& input, const Mesh& mesh, int threads, const char* name) {
  const auto before = std::chrono::steady_clock::now();
  const Model model = build_model(input, {mesh});
  Workspace work(model, threads);
  State state = start(model, work);
  const double setup = seconds_since(before);
  const auto begin = std::chrono::steady_clock::now();
  while (!finished(model, state)) step(model, state, work);
  const double seconds = seconds_since(begin);
  fmt::print(
      "{{\"numbering\": \"{}\", \"elements\": {}, \"threads\": {}, \"steps\": {}, \"setup_seconds\": {:.4f}, "
      "\"million_element_steps_per_second\": {:.2f}}}\n",
      name, model.element_count, threads, state.clock.step, setup,
      1e-6 * model.element_count * static_cast<double>(state.clock.step) / seconds);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Steps on a mesh numbered as generated, and at random."};
  double elements = 204800;
  double simulated = 1e-4;
  int threads = 1;
  app.add_option("--elements", elements, "about so many")->check(CLI::Range(800.0, 1e7));
  app.add_option("--simulated", simulated, "how long the impact is followed, s")->check(CLI::PositiveNumber);
  app.add_option("--threads", threads)->check(CLI::Range(1, 256));
  CLI11_PARSE(app, argc, argv);

  Case input = load_case(UDAR_SOURCE_DIR "/cases/short-beam/short-beam.toml");
  auto& beam = std::get<RectangleMesh>(input.bodies[0].mesh);
  beam.element_size = beam.size.x / std::round(std::sqrt(2 * elements));
  input.run.end_time = simulated;
  const Mesh mesh = generate(input.bodies[0].mesh);
  measure(input, mesh, threads, "generated");
  measure(input, shuffled(mesh), threads, "random");
  return 0;
}
