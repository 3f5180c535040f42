#include "udar/report/verification_page.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <limits>

#include "tests/results/scratch.hpp"
#include "udar/base/error.hpp"
#include "udar/report/markdown.hpp"
#include "udar/report/verification_plots.hpp"
#include "udar/results/file.hpp"

using namespace udar;

namespace {

std::string html(std::string_view markdown) {
  return html_of(markdown, [](const std::string& target) { return target; });
}

bool holds_text(const std::string& text, std::string_view part) { return text.find(part) != text.npos; }

std::size_t count_of_text(const std::string& text, std::string_view part) {
  std::size_t count = 0;
  for (std::size_t at = 0; (at = text.find(part, at)) != text.npos; at += part.size()) ++count;
  return count;
}

Verification small() {
  VerifiedPart part{.name = "a part", .is_long = true, .seconds = 2};
  part.rows = {{.kind = CheckKind::relative,
                .setting = "fine",
                .what = "|T| over <N>",
                .unit = "m",
                .computed = 1.01,
                .exact = 1,
                .error = 0.01,
                .bound = 0.02,
                .holds = true},
               {.kind = CheckKind::holds, .what = "words", .holds = false}};
  part.series = {{.what = "errors", .sizes = {0.004, 0.002, 0.001}, .errors = {0.4, 0.1, 0.025}, .order = 2},
                 {.what = "errors that are zero", .sizes = {0.002, 0.001}, .errors = {0, 0}, .order = std::nan("")}};
  part.curves = {
      {.title = "a curve", .y_label = "place", .lines = {{.name = "exact", .exact = true, .x = {0, 1}, .y = {0, 1}}}}};
  part.notes = {"A note & more."};
  Verification v{.version = "udar 1", .processor = "P", .date = "2026-01-31 12:00", .seconds = 3, .cores = 2};
  v.problems = {{.id = "first",
                 .title = "a title",
                 .topic = "Waves",
                 .text = "Text, see [other](../other/README.md), [theory](../../docs/theory.md#contact), "
                         "[case](../../cases/stack/README.md).\n",
                 .parts = {part}},
                {.id = "other", .title = "another", .topic = "Waves", .text = "Text.\n", .parts = {{.name = "p"}}}};
  return v;
}

}  // namespace

TEST_CASE("Markdown becomes HTML, and text no markup") {
  CHECK(html("One *line*\nand **a bold `x < y`** one.\n\nTwo.") ==
        "<p>One <em>line</em> and <strong>a bold <code>x &lt; y</code></strong> one.</p>\n<p>Two.</p>\n");
  CHECK(html("- a\n  b\n- c\n") == "<ul>\n<li>a   b</li>\n<li>c</li>\n</ul>\n");
  CHECK(html("| a | b |\n|---|--:|\n| 1 | `2` |\n") ==
        "<table>\n<tr><th> a </th><th> b </th></tr>\n<tr><td> 1 </td><td> <code>2</code> </td></tr>\n</table>\n");
  CHECK(html("```sh\nudar <x> *y*\n```\n") == "<pre>udar &lt;x&gt; *y*\n</pre>\n");
  CHECK(html("## Title\n") == "<h5>Title</h5>\n");
  CHECK(html("[a *b*](c.md?d=\"e\")") == "<p><a href=\"c.md?d=&quot;e&quot;\">a <em>b</em></a></p>\n");
  CHECK(html("2 * 3 and a < b & [0, 1] (c) * d") == "<p>2 * 3 and a &lt; b &amp; [0, 1] (c) * d</p>\n");
  CHECK(html("an open `code, *star and [bracket") == "<p>an open `code, *star and [bracket</p>\n");
  CHECK(html("<script>alert(1)</script>") == "<p>&lt;script&gt;alert(1)&lt;/script&gt;</p>\n");
  CHECK(html("") == "");
}

TEST_CASE("links get other targets, or only their words stay") {
  const auto relink = [](const std::string& target) { return target == "a" ? std::string("b") : std::string(); };
  CHECK(relinked("[x](a) and [y](c), [0, 1] (d)", relink) == "[x](b) and y, [0, 1] (d)");
  CHECK(html_of("[x](a) and [y](c)", relink) == "<p><a href=\"b\">x</a> and y</p>\n");
}

TEST_CASE("the manual has every row, and links that lead somewhere from docs/") {
  const std::string text = verification_markdown(small());
  CHECK(holds_text(text, "**1 of 2 checks hold**"));
  CHECK(holds_text(text, "| \\|T\\| over <N> | fine | 1.01 m | 1 m | 1 % | ≤ 2 % | holds |\n"));
  CHECK(holds_text(text, "| words |  |  |  |  |  | **FAILS** |\n"));
  CHECK(holds_text(text, "[other](#other), [theory](theory.md#contact), [case](../cases/stack/README.md)"));
  CHECK(holds_text(text, "#### first: a part (long)\n"));
  CHECK(count_of_text(text, "## Waves\n") == 1);
  CHECK(count_of_text(text, "](pictures/verification-first-") == 2);
  CHECK(text.ends_with("\n"));
}

TEST_CASE("the page stands alone") {
  const std::string text = verification_html(small());
  CHECK(holds_text(text, "1 of 2 checks hold"));
  CHECK(holds_text(text, "<td>|T| over &lt;N&gt;</td>"));
  CHECK(holds_text(text, "<td class=\"bad\">FAILS</td>"));
  CHECK(holds_text(text, "see <a href=\"#other\">other</a>, theory, case."));
  CHECK(holds_text(text, "A note &amp; more."));
  CHECK(count_of_text(text, "<svg") == 2);
  CHECK(count_of_text(text, "</svg>") == 2);
  CHECK_FALSE(holds_text(text, "<script"));
  CHECK_FALSE(holds_text(text, "id=\"hatch\""));
}

TEST_CASE("errors are drawn where they have an order; three panels a picture") {
  VerifiedPart part;
  const ErrorSeries good{.what = "e", .sizes = {2, 1}, .errors = {4, 1}, .bounds = {8, 2}, .order = 2, .expected = 2};
  part.series = {good, good, good, good};
  CHECK(verification_plots(part).size() == 2);
  part.series[1].size = "time step";  // another axis
  CHECK(verification_plots(part).size() == 3);
  part.series = {good};
  const auto plots = verification_plots(part);
  REQUIRE(plots.size() == 1);
  CHECK(holds_text(plots[0].svg, "order 2.00, 2.00 expected"));
  CHECK(holds_text(plots[0].svg, ">bound<"));
  CHECK(plots[0].caption == "Errors over the element size: e");
  part.series[0].order = std::nan("");
  CHECK(verification_plots(part).empty());
  part.curves = {{.title = "nothing", .lines = {{.name = "l", .x = {}, .y = {}}}}};
  CHECK(verification_plots(part).size() == 1);
}

TEST_CASE("a folder that holds something else is left alone") {
  const Scratch scratch;
  const std::filesystem::path folder = scratch / "out";
  CHECK_NOTHROW(check_verification_folder(folder, false));
  write_verification(folder, small());
  CHECK_THROWS_AS(check_verification_folder(folder, false), UserError);
  CHECK_NOTHROW(check_verification_folder(folder, true));
  write_verification(folder, small());  // again
  std::size_t pictures = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder / "pictures")) ++pictures;
  CHECK(pictures == 2);
  CHECK(read_file(folder / "verification.html", 1 << 20) == verification_html(small()));
  CHECK_THROWS_AS(check_verification_folder(folder / "pictures", true), UserError);
  CHECK_THROWS_AS(check_verification_folder(folder / "verify.json", true), UserError);
}
