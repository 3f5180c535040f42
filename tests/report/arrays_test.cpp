#include "udar/report/arrays.hpp"

#include <limits>
#include <random>

#include "tests/report/decode.hpp"
#include "udar/report/page.hpp"

using namespace udar;

namespace {

nlohmann::json description(const PackedArray& array) { return Blocks().add(array); }

/// Largest distance between values and what is read back, in steps.
template <class Value>
double off_by(const std::vector<Value>& values, const PackedArray& array) {
  const std::vector<double> read = decoded(description(array), array.text);
  REQUIRE(read.size() == values.size());
  double most = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    REQUIRE(std::isfinite(read[i]) == std::isfinite(values[i]));
    if (std::isfinite(values[i]) && read[i] != values[i])
      most = std::max(most, std::fabs(read[i] - values[i]) / array.step);
  }
  return most;
}

}  // namespace

TEST_CASE("tables of whole numbers read back equal, of one, two and four bytes") {
  std::mt19937 random(1);
  for (const std::uint32_t largest : {1U, 255U, 256U, 65535U, 65536U, 0xFFFFFFFFU}) {
    for (const auto& [rows, columns] : {std::pair<std::size_t, std::size_t>{1, 1}, {1, 70}, {25, 1}, {13, 57}}) {
      std::vector<std::uint32_t> values(rows * columns);
      for (std::uint32_t& v : values)
        v = largest == 0xFFFFFFFFU ? static_cast<std::uint32_t>(random())
                                   : static_cast<std::uint32_t>(random()) % (largest + 1);
      values.back() = largest;
      const PackedArray array = pack_numbers(values, columns);
      CHECK(array.bytes == (largest < 256 ? 1 : largest < 65536 ? 2 : 4));
      CHECK(array.rows == rows);
      CHECK(decoded_numbers(description(array), array.text) == values);
    }
  }
}

TEST_CASE("empty tables are tables") {
  CHECK(decoded_numbers(description(pack_numbers({}, 0)), pack_numbers({}, 0).text).empty());
  const PackedArray array = pack_rounded(std::span<const float>{}, 0, 12);
  CHECK(array.rows == 0);
  CHECK(decoded(description(array), array.text).empty());
}

TEST_CASE("numbers of 32 bits read back bit by bit") {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<float> values{1.5F, -0.0F, 3e38F, std::numeric_limits<float>::infinity(), nan, 1e-40F};
  const PackedArray array = pack_floats(values, 3);
  const std::vector<double> read = decoded(description(array), array.text);
  for (std::size_t i = 0; i < values.size(); ++i) {
    CHECK(std::bit_cast<std::uint32_t>(static_cast<float>(read[i])) == std::bit_cast<std::uint32_t>(values[i]));
  }
}

TEST_CASE("a rounded number is off by half a step at most, whatever the range") {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> unit(0, 1);
  for (const int bits : {1, 7, 8, 10, 12, 16, 24, 32}) {
    for (const auto& [from, to] : {std::pair{0.0, 1.0}, {-3e8, 2e8}, {-1e-30, 1e-30}, {5.0, 5.5}}) {
      const double low = from;  // clang 14 captures no structured bindings
      const double high = to;
      std::vector<double> values(600);
      for (double& v : values) v = low + (high - low) * unit(random);
      const PackedArray array = pack_rounded(values, 60, bits);
      CAPTURE(bits);
      CAPTURE(low);
      CHECK(array.bytes == (bits <= 8 ? 1 : bits <= 16 ? 2 : 4));
      // Half, and what the doubles of the reader round: 2^-52 of the largest number, against steps of 2^-32 of the
      // range.
      CHECK(off_by(values, array) <= 0.5 + 1e-4);
      const auto [least, most] = std::minmax_element(values.begin(), values.end());
      // Between both signs one number is given for it that 0 is one of them.
      const bool zero_inside = low < 0 && bits > 1;
      CHECK(array.step ==
            doctest::Approx((*most - *least) / (std::pow(2.0, bits) - (zero_inside ? 2 : 1))).epsilon(1e-9));
    }
  }
}

TEST_CASE("between values of both signs, what is 0 stays 0") {
  for (const int bits : {8, 10, 12, 16}) {
    const std::vector<double> values{-3.7e8, 0, 1.1, 2.3e8};
    const PackedArray array = pack_rounded(values, 4, bits);
    CHECK(decoded(description(array), array.text)[1] == 0);
  }
}

TEST_CASE("numbers that are none stay none, beside all others") {
  const float infinite = std::numeric_limits<float>::infinity();
  for (const int bits : {8, 12, 16}) {
    const std::vector<float> values{0, 1, 2, std::nanf(""), infinite, -infinite, 255, 100, 3};
    const PackedArray array = pack_rounded(values, 3, bits);
    REQUIRE(array.none.has_value());
    CHECK(off_by(values, array) <= 0.5 + 1e-9);
  }
  const std::vector<float> nothing(4, std::nanf(""));
  CHECK(off_by(nothing, pack_rounded(nothing, 2, 8)) == 0);
  CHECK_FALSE(pack_rounded(std::vector<float>{1, 2}, 2, 8).none.has_value());
}

TEST_CASE("constants are exact, and so is the least number") {
  for (const float value : {0.0F, 117679800.0F, -1e-38F}) {
    const std::vector<float> values(50, value);
    CHECK(off_by(values, pack_rounded(values, 10, 12)) == 0);
  }
  const std::vector<float> strains{0, 0, 0.3F, 1.7F};
  CHECK(decoded(description(pack_rounded(strains, 4, 8)), pack_rounded(strains, 4, 8).text)[1] == 0);
}

TEST_CASE("the largest range that low + step q can have") {
  const std::vector<double> values{-0.89e308, 0, 0.89e308, 1e300};
  CHECK(off_by(values, pack_rounded(values, 2, 16)) <= 0.5 + 1e-9);
}

TEST_CASE("neighbours in mesh and time cost next to nothing") {
  std::vector<std::uint32_t> values;
  for (std::uint32_t row = 0; row < 25; ++row) {
    for (std::uint32_t column = 0; column < 1000; ++column) values.push_back(20000 + 7 * column + 11 * row);
  }
  CHECK(pack_numbers(values, 1000).text.size() < values.size() / 50);
}

TEST_CASE("bytes as text") {
  CHECK(base64("").empty());
  CHECK(base64("f") == "Zg==");
  CHECK(base64("fo") == "Zm8=");
  CHECK(base64("foo") == "Zm9v");
  CHECK(base64("\xFF\xFE\xFD\xFC") == "//79/A==");
}
