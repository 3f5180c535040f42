#include "udar/base/archive.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "tests/results/scratch.hpp"

namespace udar {
namespace {

struct Inner {
  double value = 0;
  bool yes = false;

  template <class Archive>
  void carry(Archive& archive) {
    archive(value, yes);
  }
};

struct Outer {
  std::string text;
  std::vector<Inner> inner;
  std::vector<Vec2> places;
  std::optional<std::uint64_t> number;
  CompensatedSum sum;

  template <class Archive>
  void carry(Archive& archive) {
    archive(text, inner, places, number, sum);
  }
};

std::string bytes_of_example() {
  Outer outer{.text = std::string("a\0b", 3),
              .inner = {{1.5, true}, {-0.0, false}},
              .places = {{1, 2}, {std::numeric_limits<double>::quiet_NaN(), 4}},
              .number = 7,
              .sum = {1, 1e-17}};
  BytesOut out;
  out(outer);
  return out.bytes();
}

}  // namespace

TEST_CASE("archive: what is put in comes out with its bits") {
  const std::string bytes = bytes_of_example();
  Outer read;
  read.inner.resize(5);  // what was there before goes
  read.number.reset();
  BytesIn in(bytes);
  in(read);
  in.finish();
  CHECK(read.text == std::string("a\0b", 3));
  REQUIRE(read.inner.size() == 2);
  CHECK(read.inner[0].value == 1.5);
  CHECK(read.inner[0].yes);
  CHECK(std::signbit(read.inner[1].value));
  REQUIRE(read.places.size() == 2);
  CHECK(std::isnan(read.places[1].x));
  CHECK(read.number == 7);
  CHECK(read.sum.correction == 1e-17);
  BytesOut again;
  again(read);
  CHECK(again.bytes() == bytes);
}

TEST_CASE("archive: bytes that end too early or too late are refused") {
  const std::string bytes = bytes_of_example();
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    Outer read;
    BytesIn in(std::string_view(bytes).substr(0, length));
    CHECK(message_of<OutputError>([&] { in(read); }) == "it ends too early");
  }
  const std::string longer = bytes + "x";
  Outer read;
  BytesIn in(longer);
  in(read);
  CHECK(contains(message_of<OutputError>([&] { in.finish(); }), "more in it"));
}

TEST_CASE("archive: no memory is taken for counts that the bytes do not bear out") {
  std::uint64_t huge = std::uint64_t{1} << 60;
  BytesOut out;
  out(huge);
  std::string text;
  std::vector<double> numbers;
  std::vector<Inner> inner;
  CHECK(message_of<OutputError>([&] { BytesIn(out.bytes())(text); }) == "it ends too early");
  CHECK(message_of<OutputError>([&] { BytesIn(out.bytes())(numbers); }) == "it ends too early");
  CHECK(message_of<OutputError>([&] { BytesIn(out.bytes())(inner); }) == "it ends too early");
}

}  // namespace udar
