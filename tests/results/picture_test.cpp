#include "udar/results/picture.hpp"

#include <doctest/doctest.h>
#include <zlib.h>

#include <cmath>
#include <random>

#include "tests/results/scratch.hpp"
#include "udar/results/outline.hpp"
#include "udar/results/png.hpp"
#include "udar/results/xml.hpp"

using namespace udar;

namespace {

Picture grid_picture(int columns, int rows) {
  Picture picture;
  for (int j = 0; j <= rows; ++j) {
    for (int i = 0; i <= columns; ++i) picture.points.push_back({0.4 * i / columns, 0.1 * j / rows});
  }
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      const std::int32_t a = j * (columns + 1) + i;
      picture.triangles.push_back({a, a + 1, a + columns + 2});
      picture.triangles.push_back({a, a + columns + 2, a + columns + 1});
    }
  }
  return picture;
}

int count_of(std::string_view text, std::string_view part) {
  int count = 0;
  for (auto at = text.find(part); at != std::string_view::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

/// Every tag is closed by its own name, and no number is one that SVG does not know.
bool is_sound(const std::string& svg) {
  std::vector<std::string> open;
  XmlScanner scanner(svg);
  while (const auto tag = scanner.next()) {
    const bool empty = svg[scanner.position() - 2] == '/';
    if (tag->closing) {
      if (open.empty() || open.back() != tag->name) return false;
      open.pop_back();
    } else if (!empty) {
      open.push_back(tag->name);
    }
    for (const auto& [key, value] : tag->attributes) {
      if (key == "xlink:href") continue;  // an image may have any letters
      if (contains(value, "nan") || contains(value, "inf")) return false;
    }
  }
  return open.empty();
}

}  // namespace

TEST_CASE("the outline of a mesh with a hole is two loops") {
  Picture picture = grid_picture(3, 3);
  CHECK(outline(picture.triangles).size() == 1);
  CHECK(outline(picture.triangles)[0].size() == 12);
  picture.triangles.erase(picture.triangles.begin() + 8, picture.triangles.begin() + 10);
  const auto loops = outline(picture.triangles);
  REQUIRE(loops.size() == 2);
  CHECK(loops[0].size() + loops[1].size() == 16);
  CHECK(mesh_edges(picture.triangles).size() == 12 + 12 + 8);
  CHECK(outline({}).empty());
}

TEST_CASE("triangles that touch in a point give closed loops") {
  const std::vector<Triangle> bow{{0, 1, 2}, {2, 3, 4}};
  std::size_t corners = 0;
  for (const Loop& loop : outline(bow)) corners += loop.size();
  CHECK(corners == 6);
}

TEST_CASE("clipping keeps what is inside") {
  const Extent box{{0, 0}, {1, 1}};
  CHECK(clipped({{0.2, 0.2}, {0.8, 0.2}, {0.5, 0.8}}, box).size() == 3);
  CHECK(clipped({{2, 2}, {3, 2}, {3, 3}}, box).empty());
  const Extent cut = bounds(clipped({{-1e9, 0.5}, {-1e9, -1e9}, {1e9, -1e9}, {1e9, 0.5}}, box));
  CHECK(cut.low == Vec2{0, 0});
  CHECK(cut.high == Vec2{1, 0.5});
}

TEST_CASE("a full picture is sound and of reasonable size") {
  Picture picture = grid_picture(160, 40);
  picture.title = "title";
  picture.subtitle = "subtitle";
  picture.obstacles = {{{-1e6, 0}, {-1e6, -1e6}, {1e6, -1e6}, {1e6, 0}}};
  picture.arrows = {{{0.2, 0.05}, {0, -80}, "80 m/s"}};
  picture.markers = {{{0, 0.1}, "corner"}, {{0.2, 0.05}, "middle"}};
  picture.supports = {{{0, 0}, true, true}, {{0.4, 0}, false, true}};
  PictureField field{.name = "plastic strain", .unit = "", .values = {}, .min = {}, .max = 0.5};
  for (std::size_t i = 0; i < picture.triangles.size(); ++i) {
    field.values.push_back(std::sin(0.7 * static_cast<double>(i * i % 1000)));
  }
  picture.field = field;
  const std::string svg = to_svg(picture);
  CHECK(is_sound(svg));
  CHECK(svg.size() < 2'500'000);
  for (const char* words : {">title<", ">subtitle<", ">80 m/s<", ">corner<", ">plastic strain<", ">10 cm<", "≥ 0.5"}) {
    CHECK(contains(svg, words));
  }
}

TEST_CASE("one colour is one path, whatever the number of triangles") {
  Picture picture = grid_picture(400, 100);
  CHECK(to_svg(picture).size() < 50'000);  // too fine for its mesh to be drawn
  picture = grid_picture(160, 40);
  picture.highlight = PictureHighlight{"flows now", std::vector<std::uint8_t>(picture.triangles.size())};
  for (std::size_t i = 0; i < 5000; ++i) picture.highlight->flags[i] = 1;
  CHECK(count_of(to_svg(picture), "<path") == 5);  // two fills, the mesh, the outline, the scale bar
}

TEST_CASE("colours of a fine mesh are an image, whose size the mesh does not change") {
  Picture picture = grid_picture(800, 200);
  picture.subtitle = "many elements";
  CHECK(contains(to_svg(picture), ">many elements; the mesh is too fine to be drawn<"));
  PictureField field{.name = "x", .unit = "", .values = {}, .min = 0, .max = 1};
  std::minstd_rand random;
  for (std::size_t i = 0; i < picture.triangles.size(); ++i) {
    field.values.push_back(std::uniform_real_distribution<>(0, 1)(random));  // no two neighbours alike
  }
  picture.field = field;
  const std::string svg = to_svg(picture);
  CHECK(is_sound(svg));
  CHECK(count_of(svg, "<image") == 1);
  CHECK(count_of(svg, "<path") == 2);  // the outline, the scale bar
  CHECK(svg.size() < 2'000'000);
  CHECK(contains(svg, ">many elements<"));
}

TEST_CASE("a picture tells its boundary or has it found") {
  Picture picture = grid_picture(5, 4);
  const std::string found = to_svg(picture);
  for (const Loop& loop : outline(picture.triangles)) {
    for (std::size_t k = 0; k < loop.size(); ++k) picture.boundary.push_back({loop[k], loop[(k + 1) % loop.size()]});
  }
  CHECK(loops_of(picture.boundary) == outline(picture.triangles));
  CHECK(to_svg(picture) == found);
}

TEST_CASE("a PNG has its size, its colours and every dot") {
  const std::vector<std::string_view> colours{"#ff0000", "#0080ff"};
  const DotImage image{.width = 3, .height = 2, .dots = {0, 1, 2, 2, 1, 0}};
  const std::string png = to_png(image, colours);
  CHECK(png.starts_with("\x89PNG\r\n\x1a\n"));
  const auto chunk = [&](std::string_view kind) {
    const std::size_t at = png.find(kind);
    REQUIRE(at != std::string::npos);
    const auto size = static_cast<std::size_t>(static_cast<unsigned char>(png[at - 1]));  // all are short
    return png.substr(at + 4, size);
  };
  using namespace std::string_literals;
  CHECK(chunk("IHDR") == "\0\0\0\3\0\0\0\2\x08\3\0\0\0"s);
  CHECK(chunk("PLTE") == "\0\0\0\xff\0\0\0\x80\xff"s);
  CHECK(chunk("tRNS") == "\0"s);
  const std::string packed = chunk("IDAT");
  std::string rows(8, '?');
  uLongf size = rows.size();
  REQUIRE(::uncompress(reinterpret_cast<Bytef*>(rows.data()), &size, reinterpret_cast<const Bytef*>(packed.data()),
                       packed.size()) == Z_OK);
  CHECK(rows == "\0\0\1\2\0\2\1\0"s);
  CHECK(png.ends_with("IEND\xae\x42\x60\x82"));  // with its checksum, as the standard has it
}

TEST_CASE("base64 as in its standard") {
  CHECK(to_base64("") == "");
  CHECK(to_base64("f") == "Zg==");
  CHECK(to_base64("fo") == "Zm8=");
  CHECK(to_base64("foobar") == "Zm9vYmFy");
  CHECK(to_base64("\xff\xff\xff") == "////");
}

TEST_CASE("no text of the user becomes markup") {
  Picture picture = grid_picture(1, 1);
  const std::string bad = "</text><script>alert('1')</script>\"&\x01\xff";
  picture.title = picture.subtitle = bad;
  picture.arrows = {{{0, 0}, {1, 0}, bad}};
  picture.markers = {{{0, 0}, bad}};
  picture.field = PictureField{.name = bad, .unit = bad, .values = {1, 2}, .min = {}, .max = {}};
  std::string svg = to_svg(picture);
  CHECK(is_sound(svg));
  CHECK_FALSE(contains(svg, "<script"));
  CHECK(contains(svg, "&lt;/text&gt;&lt;script&gt;alert(&apos;1&apos;)&lt;/script&gt;&quot;&amp;??"));
  picture.field.reset();
  picture.highlight = PictureHighlight{bad, {1, 0}};
  svg = to_svg(picture);
  CHECK(is_sound(svg));
  CHECK_FALSE(contains(svg, "<script"));
}

TEST_CASE("a failed run can be drawn") {
  const double nan = std::nan("");
  Picture picture = grid_picture(4, 2);
  picture.points[3] = {nan, 0};
  picture.points[5] = {0, HUGE_VAL};
  picture.triangles.push_back({0, 1, 99});
  picture.field = PictureField{.name = "x", .unit = "Pa", .values = {nan, HUGE_VAL, 3}, .min = {}, .max = {}};
  picture.obstacles = {{{nan, nan}}, {}, {{0, 0}, {1, 0}}};
  picture.arrows = {{{nan, 0}, {1, 1}, "a"}, {{0, 0}, {nan, 1}, "b"}, {{0, 0}, {0, 0}, "c"}};
  picture.markers = {{{nan, nan}, "d"}};
  picture.supports = {{{nan, 0}, true, false}};
  CHECK(is_sound(to_svg(picture)));
  CHECK(is_sound(to_svg({})));
}

TEST_CASE("text for XML keeps good characters and replaces the others") {
  CHECK(escape_xml("µm · σ₁ 😀") == "µm · σ₁ 😀");
  CHECK(escape_xml("a<b>&\"'") == "a&lt;b&gt;&amp;&quot;&apos;");
  CHECK(escape_xml("\xc0\xaf \xed\xa0\x80 \xf5") == "?? ??? ?");
  CHECK(escape_xml("\xe2\x82") == "??");
  CHECK(escape_xml(std::string_view("\0\n", 2)) == "??");
}
