#include "udar/output/run_pictures.hpp"

#include <doctest/doctest.h>

#include <algorithm>

#include "tests/output/watched_run.hpp"
#include "tests/results/scratch.hpp"
#include "tests/simulation/example.hpp"
#include "udar/results/outline.hpp"
#include "udar/results/xml.hpp"

namespace udar {
namespace {

/// True where every tag is closed in turn and the root is <svg>.
bool well_formed(const std::string& svg) {
  XmlScanner scanner(svg);
  std::vector<std::string> open;
  std::string root;
  const std::string text = svg;
  while (auto tag = scanner.next()) {
    if (root.empty()) root = tag->name;
    if (tag->closing) {
      if (open.empty() || open.back() != tag->name) return false;
      open.pop_back();
    } else if (text[scanner.position() - 2] != '/') {
      open.push_back(tag->name);
    }
  }
  return open.empty() && root == "svg";
}

}  // namespace

TEST_CASE("the picture of the set-up shows bodies, obstacles, velocity, supports and observed places") {
  Case input = falling_block();
  input.supports = {{.name = "hand", .nodes = {.body = "block", .side = "top"}, .move_x = TimeTable::constant(0)}};
  const WatchedRun run(input);
  const Picture picture = setup_picture(run.model, run.state, "a <b> & \"c\"");
  CHECK(picture.triangles.size() == run.model.element_count);
  CHECK(loops_of(picture.boundary) == outline(picture.triangles));
  CHECK(picture.obstacles.size() == 1);
  REQUIRE(picture.arrows.size() == 1);
  CHECK(picture.arrows[0].value.y == doctest::Approx(-80));
  CHECK(picture.arrows[0].at.y == doctest::Approx(0.01));
  CHECK(picture.supports.size() == 9);
  CHECK(picture.supports[0].holds_x);
  CHECK_FALSE(picture.supports[0].holds_y);
  std::vector<std::string> labels;
  for (const PictureMarker& marker : picture.markers) labels.push_back(marker.label);
  CHECK(labels == std::vector<std::string>{"corner", "bottom"});
  const std::string svg = to_svg(picture);
  CHECK(well_formed(svg));
  CHECK(contains(svg, "a &lt;b&gt; &amp; "));
  CHECK(contains(svg, "corner"));
}

TEST_CASE("the picture of the state shows plastic strain where something flowed, else the largest shear") {
  WatchedRun run(falling_block());
  const Picture before = state_picture(run.model, run.state, "block");
  CHECK(before.field->name == "largest shear stress");
  run.run([] {});
  const Picture after = state_picture(run.model, run.state, "block");
  CHECK(after.field->name == "plastic strain");
  CHECK(after.field->values.size() == after.triangles.size());
  CHECK(*std::ranges::max_element(after.field->values) > 0);
  CHECK(after.points[0].y == run.state.nodes[0].y);
  for (const Picture& picture : {before, after}) CHECK(well_formed(to_svg(picture)));
}

}  // namespace udar
