#include "udar/case/memory.hpp"

#include <doctest/doctest.h>

#include "tests/case/example.hpp"
#include "udar/base/memory.hpp"
#include "udar/case/build_model.hpp"
#include "udar/mesh/cells.hpp"
#include "udar/model/state.hpp"

using namespace udar;

namespace {

Case with(MeshShape mesh) {
  Case c = read_case(short_beam, "short-beam.toml");
  c.bodies[0].mesh = std::move(mesh);
  return c;
}

double elements_of(const MeshShape& mesh) { return static_cast<double>(generate(mesh).triangles.size()); }

}  // namespace

TEST_CASE("elements are counted before they are made") {
  const RectangleMesh rectangle{.size = {0.4, 0.1}, .element_size = 0.01};
  CHECK(elements_about(with(rectangle)) == doctest::Approx(800));
  RectangleMesh crossed = rectangle;
  crossed.diagonals = RectangleMesh::Diagonals::crossed;
  CHECK(elements_about(with(crossed)) == doctest::Approx(1600));
  const DiscMesh disc{.radius = 0.1, .element_size = 0.01};
  CHECK(elements_about(with(disc)) == doctest::Approx(elements_of(disc)));
  const RingMesh ring{.outer_radius = 0.1, .inner_radius = 0.05, .element_size = 0.005};
  CHECK(elements_about(with(ring)) == doctest::Approx(elements_of(ring)).epsilon(0.02));
}

TEST_CASE("of graded meshes not more elements are counted than there are, and not much fewer") {
  for (const char* side : {"bottom", "left"}) {
    const RectangleMesh mesh{
        .size = {0.4, 0.1}, .element_size = 0.02, .finest_size = 0.0005, .finest_side = side, .finest_within = 0.01};
    const double counted = elements_about(with(mesh));
    CHECK(counted <= elements_of(mesh));
    CHECK(counted > 0.2 * elements_of(mesh));
  }
  const RectangleMesh corner{
      .size = {0.4, 0.1}, .element_size = 0.02, .finest_size = 0.0005, .finest_at = Vec2{0, 0}, .finest_within = 0.03};
  CHECK(elements_about(with(corner)) <= elements_of(corner));
  CHECK(elements_about(with(corner)) > 0.2 * elements_of(corner));
  const DiscMesh disc{.radius = 0.1, .element_size = 0.02, .finest_size = 0.001, .finest_side = "outer"};
  CHECK(elements_about(with(disc)) <= elements_of(disc));
  const RingMesh ring{.outer_radius = 0.1,
                      .inner_radius = 0.05,
                      .element_size = 0.01,
                      .finest_size = 0.0005,
                      .finest_side = "inner",
                      .finest_within = 0.02};
  CHECK(elements_about(with(ring)) <= elements_of(ring));
  CHECK(elements_about(with(ring)) > 0.2 * elements_of(ring));
}

TEST_CASE("what no machine has is refused with the number of elements, the memory and a cure") {
  CHECK(memory_there() > 0);
  CHECK_NOTHROW(check_memory_for(1, 1));
  // 5e14 elements: 100 000 TB.
  const Case c = with(RectangleMesh{.size = {1, 1}, .element_size = 6.3e-8});
  try {
    build_model(c);
    FAIL("it was built");
  } catch (const UserError& error) {
    CHECK(error.code == ExitCode::resources);
    const Diagnostic& d = error.diagnostics.front();
    CHECK(d.message.find("elements need") != std::string::npos);
    CHECK(d.message.find("TB of memory at least") != std::string::npos);
    CHECK(d.cure.find("element_size") != std::string::npos);
  }
}

TEST_CASE("obstacles count as well: each has springs at every outer node") {
  Case c = with(RectangleMesh{.size = {1, 0.001}, .element_size = 0.001});
  const double before = memory_about(c);
  c.obstacles.resize(c.obstacles.size() + 100);
  CHECK(memory_about(c) - before == doctest::Approx(100 * (16 + sizeof(SpringState)) * 2002.0));
}
