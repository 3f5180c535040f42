#include "udar/report/frame_picture.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "tests/report/small_run.hpp"
#include "udar/report/strip.hpp"

using namespace udar;

namespace {

int count_of(std::string_view text, std::string_view part) {
  int count = 0;
  for (auto at = text.find(part); at != std::string_view::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

FrameView view_of_field(std::string_view name) {
  FrameView view;
  view.field = &find_field(name);
  return view;
}

Picture picture_of(const Frame& frame, const FrameView& view) {
  FrameSurvey survey(view);
  survey.add(frame);
  return survey.picture_of(frame);
}

}  // namespace

TEST_CASE("frames are found by their time") {
  const SmallRun run({0, 1e-3, 2.5e-3});
  const RunFrames frames(run.folder);
  CHECK(case_name_of(frames.files()) == "small");
  REQUIRE(frames.count() == 3);
  CHECK(frames.time(1) == 1e-3);
  CHECK(frames.time(2) == 2.5e-3);
  CHECK(frames.nearest(-1) == 0);
  CHECK(frames.nearest(0.4e-3) == 0);
  CHECK(frames.nearest(0.6e-3) == 1);
  CHECK(frames.nearest(1) == 2);
  const Frame frame = frames.read(1);
  CHECK(frame.time == 1e-3);
  CHECK(frame.triangles.size() == 4);
  CHECK(frame.obstacles.size() == 1);
  CHECK(frame.bodies.points[4].x == doctest::Approx(2.1));
}

TEST_CASE("what is no run, or a run without frames, is refused with a cure") {
  const SmallRun run({});
  CHECK(contains(message_of<UserError>([&] { RunFrames{run.folder}; }), "output.fields_every"));
  CHECK(contains(message_of<UserError>([&] { RunFrames{run.scratch.path}; }), "is not the folder of a run"));
  CHECK(contains(message_of<UserError>([&] { RunFrames{run.folder / "nothing"}; }), "is not there"));
}

TEST_CASE("fields go by long and short names, and wrong ones are told with the one that was meant") {
  CHECK(&find_field("sigma1") == &find_field("principal_1"));
  CHECK(&find_field("plastic") == &find_field("plastic_strain"));
  CHECK(&find_field("flows") == &find_field("flows_now"));
  CHECK(contains(message_of<UserError>([] { find_field("sigam1"); }), "did you mean `sigma1`?"));
  CHECK(contains(message_of<UserError>([] { find_field("vel"); }), "did you mean `velocity`?"));
  CHECK(contains(message_of<UserError>([] { find_field("temperature"); }), "write plastic, sigma1"));
}

TEST_CASE("a picture has the values of the frame, in the unit that is shown") {
  const SmallRun run({1e-3});
  const Frame frame = RunFrames(run.folder).read(0);
  FrameView view = view_of_field("sigma1");
  const Picture picture = picture_of(frame, view);
  REQUIRE(picture.field);
  CHECK(picture.field->unit == "MPa");
  CHECK(picture.field->values == std::vector<double>{1, -2, 3, 1});
  CHECK(picture.subtitle == "t = 1 ms");
  view.unit = HumanUnit{"kPa", 1e3};
  CHECK(picture_of(frame, view).field->values[1] == doctest::Approx(-2000));

  // The corners of the third triangle move with (100, 4), (100, 5), (100, 6) m/s.
  const Picture y = picture_of(frame, view_of_field("velocity_y"));
  CHECK(y.field->values[0] == 0);
  CHECK(y.field->values[2] == doctest::Approx(5));
  const Picture size = picture_of(frame, view_of_field("velocity"));
  const double mean = (std::hypot(100, 4) + std::hypot(100, 5) + std::hypot(100, 6)) / 3;
  CHECK(size.field->values[2] == doctest::Approx(mean));
}

TEST_CASE("a rigid body has no stress, but it moves") {
  const SmallRun run({1e-3});
  Frame frame = RunFrames(run.folder).read(0);
  frame.rigid = {0, 1};
  for (const bool smooth : {false, true}) {
    FrameView view = view_of_field("sigma1");
    view.smooth = smooth;
    const Picture picture = picture_of(frame, view);
    CHECK(std::isfinite(picture.field->values.front()));
    CHECK(std::isnan(picture.field->values.back()));
    CHECK(picture.field->max.value() == doctest::Approx(2));  // that of the first body alone, which has -2 MPa
  }
  CHECK(std::isfinite(picture_of(frame, view_of_field("velocity")).field->values.back()));
}

TEST_CASE("smooth values are the means round each node, bodies apart") {
  const SmallRun run({1e-3});
  const Frame frame = RunFrames(run.folder).read(0);
  FrameView view = view_of_field("sigma1");
  view.smooth = true;
  const Picture picture = picture_of(frame, view);
  CHECK(picture.field->at_points);
  const std::vector<double> expected{-0.5, 1, -0.5, -2, 2, 3, 2, 1};
  for (std::size_t i = 0; i < 8; ++i) CHECK(picture.field->values[i] == doctest::Approx(expected[i]));
  CHECK(contains(to_svg(picture), "data:image/png;base64,"));
}

TEST_CASE("flow is light, lighter where it goes on; forces of contact are arrows") {
  const SmallRun run({1e-3});
  const Frame frame = RunFrames(run.folder).read(0);
  CHECK(flow_flags(frame) == std::vector<std::uint8_t>{0, 1, 2, 0});
  const Picture flows = picture_of(frame, view_of_field("flows"));
  REQUIRE(flows.highlight);
  CHECK_FALSE(flows.field);
  const Picture contact = picture_of(frame, view_of_field("contact"));
  REQUIRE(contact.forces);
  CHECK(contact.forces->longest == doctest::Approx(std::hypot(100, 7)));
  const std::string svg = to_svg(contact);
  CHECK(count_of(svg, "contact force on the bodies") == 1);
}

TEST_CASE("ranges of colours are round, begin or end at 0, and are two-sided only where both signs matter") {
  CHECK(round_range(0, 0.477) == std::pair{0.0, 0.5});
  CHECK(round_range(-0.01, 2.1) == std::pair{0.0, 2.5});
  CHECK(round_range(-240, 10) == std::pair{-250.0, 0.0});
  CHECK(round_range(-100, 235) == std::pair{-250.0, 250.0});
  CHECK(round_range(0, 0) == std::pair{0.0, 1.0});
  const SmallRun run({1e-3});
  const Frame frame = RunFrames(run.folder).read(0);
  FrameView view = view_of_field("sigma1");
  CHECK(picture_of(frame, view).field->colours == ColourMap::two_sided);
  CHECK(picture_of(frame, view_of_field("velocity")).field->colours == ColourMap::rising);
  view.range = {0, 2e6};
  const Picture given = picture_of(frame, view);
  CHECK(*given.field->max == doctest::Approx(2));
  CHECK(given.field->colours == ColourMap::rising);
  view.range = {-2e6, 2e6};
  CHECK(picture_of(frame, view).field->colours == ColourMap::two_sided);
}

TEST_CASE("frames that are shown together have one range and one view; one that follows a body moves with it") {
  const SmallRun run({0, 10e-3});
  const RunFrames frames(run.folder);
  FrameView view = view_of_field("sigma1");
  FrameSurvey survey(view);
  for (const std::size_t k : {0, 1}) survey.add(frames.read(k));
  const Picture first = survey.picture_of(frames.read(0));
  const Picture last = survey.picture_of(frames.read(1));
  CHECK(*first.field->max == *last.field->max);
  CHECK(first.view->low == last.view->low);
  CHECK(first.view->high == last.view->high);
  CHECK(last.view->high.x > 4);  // the second body has come to x = 4

  view.follow = 1;
  FrameSurvey followed(view);
  for (const std::size_t k : {0, 1}) followed.add(frames.read(k));
  const Extent a = *followed.picture_of(frames.read(0)).view;
  const Extent b = *followed.picture_of(frames.read(1)).view;
  CHECK(a.centre().x == doctest::Approx(2.5));
  CHECK(b.centre().x == doctest::Approx(3.5));
  CHECK(b.size().x == doctest::Approx(a.size().x));
}

TEST_CASE("a strip has its panes in rows, none over another, one legend, and every title") {
  const SmallRun run({0, 1e-3, 2e-3, 3e-3, 4e-3});
  const RunFrames frames(run.folder);
  FrameSurvey survey(view_of_field("sigma1"));
  for (std::size_t k = 0; k < 5; ++k) survey.add(frames.read(k));
  PictureStrip strip{.title = "small & \"quoted\" <title>"};
  for (std::size_t k = 0; k < 5; ++k) {
    strip.pictures.push_back(survey.picture_of(frames.read(k)));
    strip.pictures.back().title = "pane " + std::to_string(k);
  }
  strip.columns = 2;
  const std::string svg = to_svg(strip);
  CHECK(contains(svg, "small &amp; &quot;quoted&quot; &lt;title&gt;"));
  CHECK(count_of(svg, "first principal stress") == 1);
  // The frame of each pane: x, y, width, height.
  std::vector<std::array<double, 4>> panes;
  for (std::size_t k = 0; k < 5; ++k) {
    CHECK(count_of(svg, "pane " + std::to_string(k)) == 1);
    const std::string clip = "<clipPath id=\"plot" + std::to_string(k) + "\"><rect ";
    const auto at = svg.find(clip);
    REQUIRE(at != std::string::npos);
    std::array<double, 4>& p = panes.emplace_back();
    REQUIRE(std::sscanf(svg.c_str() + at + clip.size(), R"(x="%lf" y="%lf" width="%lf" height="%lf")", &p[0], &p[1],
                        &p[2], &p[3]) == 4);
  }
  CHECK(panes[0][1] == panes[1][1]);
  CHECK(panes[0][0] == panes[2][0]);
  for (std::size_t i = 0; i < 5; ++i) {
    CHECK(panes[i][0] >= 0);
    CHECK(panes[i][0] + panes[i][2] <= 1000);
    CHECK(panes[i][2] == panes[0][2]);
    for (std::size_t j = 0; j < i; ++j) {
      const bool apart = panes[i][0] >= panes[j][0] + panes[j][2] || panes[j][0] >= panes[i][0] + panes[i][2] ||
                         panes[i][1] >= panes[j][1] + panes[j][3];
      CHECK(apart);
    }
  }
}

TEST_CASE("a frame without the field is told") {
  const SmallRun run({0});
  const Frame frame = RunFrames(run.folder).read(0);
  CHECK(contains(message_of<OutputError>([&] { element_values(frame, find_field("pressure")); }),
                 "has no field `pressure_Pa`"));
}
