#include "udar/units/quantity.hpp"

#include <doctest/doctest.h>

#include <numbers>
#include <string>

#include "udar/units/unit_table.hpp"

namespace udar {
namespace {

double si(std::string_view text, Dimension needed) {
  const auto value = parse_si(text, needed);
  INFO(text);
  REQUIRE(value.has_value());
  return *value;
}

std::string complaint(std::string_view text, Dimension needed) {
  const auto value = parse_si(text, needed);
  if (value) return "";
  return value.error().what + "; " + value.error().reason + "; " + value.error().cure;
}

bool has(const std::string& text, std::string_view part) { return text.find(part) != std::string::npos; }

TEST_CASE("quantities come out as the nearest double of their SI value") {
  CHECK(si("80 m/s", dimension::velocity) == 80);
  CHECK(si("2400 kgf/cm^2", dimension::stress) == 235359600);
  CHECK(si("2e6 kgf/cm^2", dimension::stress) == 1.96133e11);
  CHECK(si("2e6 kgf/cm", dimension::stiffness) == 1961330000);
  CHECK(si("6.4e-8 s", dimension::time) == 6.4e-8);
  CHECK(si("-9.81 m/s^2", dimension::acceleration) == -9.81);
  CHECK(si("0.25 cm", dimension::length) == 0.0025);
  CHECK(si("20 us", dimension::time) == 2e-5);
  CHECK(si("0.52 ms", dimension::time) == 0.00052);
  CHECK(si("7850 kg/m^3", dimension::density) == 7850);
  CHECK(si("7.85 g/cm^3", dimension::density) == 7850);
  CHECK(si("210 GPa", dimension::stress) == 2.1e11);
  CHECK(si("1 N/mm^2", dimension::stress) == 1e6);
  CHECK(si("3 um", dimension::length) == 3e-6);
  CHECK(si("5 1/s", dimension::rate) == 5);
  CHECK(si("5 /s", dimension::rate) == 5);
  CHECK(si("5 rad/s", dimension::spin) == 5);
  CHECK(si("5 1/s", dimension::spin) == 5);
  CHECK(si("60 rpm", dimension::spin) == doctest::Approx(2 * std::numbers::pi));
  CHECK(si("180 deg", dimension::angle) == std::numbers::pi);
  CHECK(si("1 kN/m", dimension::stiffness) == 1000);
  CHECK(si("1 tf", dimension::force) == 9806.65);
  CHECK(si("1 lbf", dimension::force) == 4.4482216152605);
  CHECK(si("1 psi", dimension::stress) == doctest::Approx(6894.757293168361));
  CHECK(si("1 ft", dimension::length) == 0.3048);
  CHECK(si("35 %", dimension::number) == 0.35);
  CHECK(si("0.35", dimension::number) == 0.35);
}

TEST_CASE("units may be written in several ways") {
  CHECK(si("80m/s", dimension::velocity) == 80);
  CHECK(si("  +80  m / s ", dimension::velocity) == 80);
  CHECK(si("9.81 m/s/s", dimension::acceleration) == 9.81);
  CHECK(si("9.81 m s^-2", dimension::acceleration) == 9.81);
  CHECK(si("9.81 m*s-2", dimension::acceleration) == 9.81);
  CHECK(si("7850 kg/m3", dimension::density) == 7850);
  CHECK(si("2 kg/(m s^2)", dimension::stress) == 2);
  CHECK(si("2 ((N))/((m)*(m))", dimension::stress) == 2);
  CHECK(si("20 \u00b5s", dimension::time) == 2e-5);
  CHECK(si("20 \u03bcs", dimension::time) == 2e-5);
  CHECK(si("7850 kg/m\u00b3", dimension::density) == 7850);
  CHECK(si("35\u00b0", dimension::angle) == si("35 deg", dimension::angle));
  CHECK(si("1E3 mm", dimension::length) == 1);
  CHECK(si("1e+2 cm", dimension::length) == 1);
}

TEST_CASE("a number without unit is told from one with a unit") {
  const auto bare = parse_quantity("80");
  REQUIRE(bare.has_value());
  CHECK(bare->bare);
  const auto with_unit = parse_quantity("80 m/m");
  REQUIRE(with_unit.has_value());
  CHECK_FALSE(with_unit->bare);
  CHECK(with_unit->dimension == dimension::number);
}

TEST_CASE("a wrong unit is named and a better one proposed") {
  CHECK(complaint("80 m", dimension::velocity) ==
        "wrong unit; this is a length; a velocity is needed; did you mean \"80 m/s\"?");
  CHECK(complaint("80", dimension::velocity) == "missing unit; a velocity is needed; in SI units write \"80 m/s\"");
  CHECK(has(complaint("35", dimension::angle), "write \"35 deg\" or \"35 rad\""));
  CHECK(has(complaint("2e6 kgf", dimension::stiffness), "did you mean \"2e6 kgf/cm\"?"));
  CHECK(has(complaint("2400 kgf", dimension::stress), "did you mean \"2400 kgf/cm^2\"?"));
  CHECK(has(complaint("7850 kg", dimension::density), "did you mean \"7850 kg/m^3\"?"));
  CHECK(has(complaint("80 m/s", dimension::length), "did you mean \"80 m\"?"));
  CHECK(has(complaint("-9.81 m/s", dimension::acceleration), "did you mean \"-9.81 m/s^2\"?"));
  CHECK(has(complaint("30 deg", dimension::number), "this is an angle; a plain number is needed"));
  CHECK(has(complaint("3 kg m^2/s^5", dimension::length), "this is a quantity in kg m^2/s^5; a length is needed"));
  CHECK(has(complaint("3 kg", dimension::time), "write it like \"2 ms\""));
}

TEST_CASE("an unknown unit is answered with the nearest one") {
  CHECK(has(complaint("80 mpa", dimension::stress), "did you mean \"80 MPa\"?"));
  CHECK(has(complaint("80 Gpa", dimension::stress), "did you mean \"80 GPa\"?"));
  CHECK(has(complaint("80 kfg/cm^2", dimension::stress), "did you mean \"80 kgf/cm^2\"?"));
  CHECK(has(complaint("80 kfg/Cm^2", dimension::stress), "did you mean \"80 kgf/cm^2\"?"));
  CHECK(has(complaint("80 kfg/ cm\t]", dimension::stress), "did you mean `kgf`?"));
  CHECK(has(complaint("80 parsec", dimension::length), "unknown unit `parsec`"));
  CHECK(has(complaint("5 Hz", dimension::spin), "unknown unit `Hz`"));
}

TEST_CASE("what is no quantity is refused, and the reason said") {
  for (const char* text : {"",
                           " ",
                           "m",
                           "m/s",
                           "0x10 m",
                           "inf m",
                           "nan",
                           "-inf",
                           "1e400 m",
                           "1e-400 m",
                           "--5 m",
                           "+-5 m",
                           "1.5.2 m",
                           "5 m/",
                           "5 /",
                           "5 *m",
                           "5 m^",
                           "5 m^2.5",
                           "5 m^22",
                           "5 (m",
                           "5 m)",
                           "5 ()",
                           "5 m//s",
                           "5 m^^2",
                           "5 $",
                           "5 m\n",
                           "5 m;",
                           ".5 m",
                           "5. m",
                           "1_000 m",
                           "5 1",
                           "5 1m",
                           "1e300 Gm Gm",
                           "5 m m m\xff",
                           "5 \xc2",
                           "1e2147483647 Gm",
                           "0e99999999999 Gm"}) {
    INFO(text);
    CHECK_FALSE(parse_quantity(text).has_value());
    const auto needed = parse_si(text, dimension::length);
    REQUIRE_FALSE(needed.has_value());
    CHECK_FALSE(needed.error().what.empty());
    CHECK_FALSE(needed.error().reason.empty());
    CHECK_FALSE(needed.error().cure.empty());
  }
  CHECK(has(complaint("1,5 m", dimension::length), "did you mean \"1.5 m\"?"));
  // What would be no quantity with a point either, or holds what a terminal obeys, is not proposed.
  CHECK(has(complaint("2e6,0 m", dimension::length), "write it like"));
  CHECK(has(complaint("1,5\tm _{\tm", dimension::length), "write it like"));
  CHECK(has(complaint("1,5,5 m", dimension::length), "write it like"));
  CHECK(has(complaint("3 kg/m s", dimension::length), "ambiguous unit"));
  CHECK(has(complaint(std::string(101, '1'), dimension::length), "101 characters are too many"));
  CHECK(has(complaint("1 " + std::string(90, '('), dimension::length), "the unit ends too early"));
}

TEST_CASE("SI texts read back to the same value") {
  for (const Dimension d :
       {dimension::length, dimension::velocity, dimension::density, dimension::stress, dimension::spin, dimension::rate,
        dimension::wave_number, dimension::angle, dimension::stiffness, dimension::force, dimension::acceleration,
        dimension::number, Dimension{2, 3, -5}, Dimension{0, 0, -7}, Dimension{-1, -1, 0}}) {
    for (const double value : {0.1, -2.5e-300, 1e22, 0.0, 6.4e-8, 1.0 / 3}) {
      INFO(si_text(value, d));
      CHECK(si(si_text(value, d), d) == value);
    }
    CHECK_FALSE(dimension_name(d).empty());
    std::string example = example_of(d);
    std::erase(example, '"');
    CHECK(parse_si(example, d).has_value());
  }
}

TEST_CASE("every unit name is found, and no two units share one") {
  CHECK(unit_names().size() > 60);
  for (std::size_t i = 0; i < unit_names().size(); ++i) {
    CHECK(find_unit(unit_names()[i]).has_value());
    for (std::size_t j = 0; j < i; ++j) CHECK(unit_names()[i] != unit_names()[j]);
  }
}

}  // namespace
}  // namespace udar
