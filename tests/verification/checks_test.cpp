#include "udar/verification/checks.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

using namespace udar;

namespace {

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();
constexpr double infinite = std::numeric_limits<double>::infinity();

}  // namespace

TEST_CASE("bounds belong to what holds, except for below and above") {
  VerifiedPart part;
  Checks checks{part};
  CHECK(checks.within("w", 1.25, 1, 0.25));
  CHECK_FALSE(checks.within("w", 1.25, 1, 0.2499));
  CHECK(checks.within("w", -1.25, -1, 0.25));
  CHECK(checks.near("n", 2.5, 2, 0.5));
  CHECK_FALSE(checks.near("n", 1.4, 2, 0.5));
  CHECK(checks.equal("e", 3, 3));
  CHECK_FALSE(checks.equal("e", 3, std::nextafter(3.0, 4.0)));
  CHECK(checks.at_most("m", 2, 2));
  CHECK_FALSE(checks.at_most("m", 2.001, 2));
  CHECK(checks.below("b", 1.999, 2));
  CHECK_FALSE(checks.below("b", 2, 2));
  CHECK(checks.at_least("l", 2, 2));
  CHECK_FALSE(checks.at_least("l", 1.999, 2));
  CHECK(checks.above("a", 2.001, 2));
  CHECK_FALSE(checks.above("a", 2, 2));
  CHECK(checks.between("t", 1, 1, 2));
  CHECK(checks.between("t", 2, 1, 2));
  CHECK_FALSE(checks.between("t", 0.999, 1, 2));
  CHECK_FALSE(checks.between("t", 2.001, 1, 2));
  CHECK(checks.holds("h", true));
  CHECK_FALSE(checks.holds("h", false));
  const CheckCount count = count_of(VerifiedProblem{.id = "p", .parts = {part}});
  CHECK(count.held == 11);
  CHECK(count.all == 21);
}

TEST_CASE("what is no number holds nowhere, nor what is infinite") {
  for (const double value : {no_number, infinite, -infinite}) {
    CAPTURE(value);
    VerifiedPart part;
    Checks checks{part};
    CHECK_FALSE(checks.within("w", value, 1, infinite));
    CHECK_FALSE(checks.near("n", value, value, 1));
    CHECK_FALSE(checks.equal("e", value, value));
    CHECK_FALSE(checks.at_most("m", value, infinite));
    CHECK_FALSE(checks.below("b", value, infinite));
    CHECK_FALSE(checks.at_least("l", value, -infinite));
    CHECK_FALSE(checks.above("a", value, 1));
    CHECK_FALSE(checks.between("t", value, -infinite, infinite));
    CHECK_FALSE(checks.order({.what = "o", .sizes = {1, 0.5}, .errors = {1, value}}, {}));
  }
  VerifiedPart part;
  Checks checks{part};
  CHECK_FALSE(checks.within("exact is none", 1, no_number, 1));
  CHECK_FALSE(checks.within("exact is 0", 0, 0, 1));  // a relative error has no meaning there
  CHECK_FALSE(checks.within("bound is none", 1, 1, no_number));
  CHECK_FALSE(checks.at_most("bound is none", 1, no_number));
}

TEST_CASE("the order of errors") {
  ErrorSeries series{.what = "errors", .sizes = {0.4, 0.2, 0.05}, .errors = {0.8, 0.2, 0.0125}};
  CHECK(order_of(series) == doctest::Approx(2).epsilon(1e-14));
  CHECK(order_of(series, OrderFrom::ends) == doctest::Approx(2).epsilon(1e-14));
  CHECK(order_of(series, OrderFrom::fit) == doctest::Approx(2).epsilon(1e-14));

  // Sizes 4, 2, 1 and errors 16, 2, 1: 1 by the last two, 2 by the ends; the line through all has the slope of the
  // ends.
  series = {.what = "errors", .sizes = {4, 2, 1}, .errors = {16, 2, 1}};
  CHECK(order_of(series) == doctest::Approx(1).epsilon(1e-14));
  CHECK(order_of(series, OrderFrom::ends) == doctest::Approx(2).epsilon(1e-14));
  CHECK(order_of(series, OrderFrom::fit) == doctest::Approx(2).epsilon(1e-14));

  VerifiedPart part;
  Checks checks{part};
  checks.setting("of one mesh");
  CHECK(checks.order(series, {.expected = 1, .least = 0.9, .most = 1.1}));
  CHECK_FALSE(checks.order(series, {.expected = 1, .least = 1.1}));
  CHECK_FALSE(checks.order(series, {.expected = 1, .least = 0.5, .most = 0.9}));
  CHECK_FALSE(checks.order({.what = "one mesh", .sizes = {1}, .errors = {1}}, {}));
  CHECK_FALSE(checks.order({.what = "no error left", .sizes = {2, 1}, .errors = {1, 0}}, {}));
  REQUIRE(part.series.size() == 5);
  CHECK(part.series[0].order == doctest::Approx(1).epsilon(1e-14));
  CHECK(part.rows[0].what == "order of errors");
  CHECK(part.rows[0].setting.empty());
  checks.series(series);
  CHECK(part.rows.size() == 5);  // drawn, not judged
}

TEST_CASE("rows keep their setting and stand together by their names") {
  VerifiedPart part;
  Checks checks{part};
  for (const char* setting : {"coarse", "fine"}) {
    checks.setting(setting);
    checks.at_most("force", 1, 2, "N");
    checks.holds("symmetry", true);
  }
  const auto groups = grouped(part);
  REQUIRE(groups.size() == 2);
  REQUIRE(groups[0].size() == 2);
  CHECK(groups[0][0]->setting == "coarse");
  CHECK(groups[0][1]->setting == "fine");
  CHECK(groups[1][0]->what == "symmetry");
}

TEST_CASE("what a long part repeats of a quick one counts once") {
  const CheckRow coarse{.kind = CheckKind::relative,
                        .setting = "10",
                        .what = "force",
                        .computed = 1.1,
                        .exact = 1,
                        .error = 0.1,
                        .bound = 0.2,
                        .holds = true};
  CheckRow fine = coarse;
  fine.setting = "20";
  CheckRow another = coarse;
  another.computed = std::nextafter(1.1, 2);
  another.holds = false;
  const CheckRow words{.kind = CheckKind::holds, .what = "mirror symmetry", .holds = true};
  const VerifiedPart quick{.name = "quick", .rows = {coarse, coarse, words}};
  const VerifiedPart more{.name = "long", .is_long = true, .rows = {coarse, fine, another, words}};
  const CheckCount count = count_of(VerifiedProblem{.id = "p", .parts = {quick, more}});
  CHECK(count.all == 6);  // all but the coarse one of the long part: words may be about something else
  CHECK(count.held == 5);
  const Verification twice{.problems = {{.id = "p", .parts = {quick}}, {.id = "q", .parts = {quick}}}};
  CHECK(count_of(twice).all == 6);
}

TEST_CASE("the words of a row") {
  VerifiedPart part;
  Checks checks{part};
  checks.within("w", 1.25, 1, 0.125, "m");
  checks.near("n", 1.25, 1, 0.5, "m");
  checks.order({.what = "o", .sizes = {2, 1}, .errors = {4, 1}}, {.expected = 2, .least = 1.8, .most = 2.2});
  checks.at_least("l", no_number, 3, "N");
  checks.holds("h", true);
  const auto words = [&](std::size_t row) {
    const CheckWords w = words_of(part.rows[row]);
    return w.computed + "|" + w.exact + "|" + w.error + "|" + w.bound + "|" + w.verdict;
  };
  CHECK(words(0) == "1.25 m|1 m|25 %|≤ 12.5 %|FAILS");
  CHECK(words(1) == "1.25 m|1 m|0.25 m|≤ 0.5 m|holds");
  CHECK(words(2) == "2.00|2.00||1.8 … 2.2|holds");
  CHECK(words(3) == "no number|||≥ 3 N|FAILS");
  CHECK(words(4) == "||||holds");
}
