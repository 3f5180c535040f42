#include "udar/report/choose.hpp"

#include <doctest/doctest.h>

using namespace udar;

namespace {

Choice everything() {
  return {.words = {"velocity", "acceleration", "plastic_strain", "principal_1", "principal_2", "principal_3"}};
}

using Numbers = std::vector<std::size_t>;

}  // namespace

TEST_CASE("the first and the last frame are kept") {
  CHECK(chosen_frames(5, 1) == Numbers{0, 1, 2, 3, 4});
  CHECK(chosen_frames(5, 2) == Numbers{0, 2, 4});
  CHECK(chosen_frames(6, 2) == Numbers{0, 2, 4, 5});
  CHECK(chosen_frames(6, 99) == Numbers{0, 5});
  CHECK(chosen_frames(1, 4) == Numbers{0});
  CHECK(chosen_frames(0, 1).empty());
  CHECK(chosen_frames(6, 0).empty());
}

TEST_CASE("as many frames as asked for, and not half as many") {
  for (std::size_t total = 0; total < 60; ++total) {
    for (std::size_t most = 2; most < 70; ++most) {
      const std::size_t every = every_for(total, most);
      CAPTURE(total);
      CAPTURE(most);
      CHECK(chosen_frames(total, every).size() <= most);
      if (every > 1) CHECK(chosen_frames(total, every - 1).size() > most);
    }
  }
}

TEST_CASE("what goes first and what goes last") {
  Ladder ladder(everything(), 9, {});
  CHECK(ladder.sentences().empty());
  REQUIRE(ladder.step());
  CHECK_FALSE(ladder.choice().has("acceleration"));
  REQUIRE(ladder.step());
  CHECK(ladder.choice().bits == 10);
  REQUIRE(ladder.step());
  CHECK_FALSE(ladder.choice().has("velocity"));
  REQUIRE(ladder.step());
  CHECK(ladder.choice().bits == 8);
  REQUIRE(ladder.step());
  CHECK(ladder.choice().every == 2);
  REQUIRE(ladder.step());
  CHECK_FALSE(ladder.choice().forces);
  REQUIRE(ladder.step());
  CHECK_FALSE(ladder.choice().has("principal_2"));
  CHECK(ladder.sentences() == std::vector<std::string>{
                                  "accelerations are left out: they are in fields/",
                                  "velocities are left out: they are in fields/",
                                  "contact forces are left out: they are in fields/",
                                  "the second principal stress is left out: it is in fields/",
                                  "fields are stored to 1/255 of their range",
                                  "every 2nd of 9 frames is here",
                              });
  REQUIRE(ladder.step());
  CHECK(ladder.sentences().back() == "every 4th of 9 frames is here");
  REQUIRE(ladder.step());
  CHECK(ladder.sentences().back() == "only the first and the last of 9 frames are here");
  REQUIRE(ladder.step());
  CHECK(ladder.sentences().back() == "none of 9 frames is here: they are in fields/");
  CHECK_FALSE(ladder.step());
}

TEST_CASE("what was asked for by name stays") {
  Ladder ladder(everything(), 100, {"acceleration", "principal_2", "contact_force"});
  while (ladder.choice().every < 8) REQUIRE(ladder.step());
  CHECK(ladder.choice().has("acceleration"));
  CHECK(ladder.choice().has("principal_2"));
  CHECK(ladder.choice().forces);
  CHECK_FALSE(ladder.choice().has("velocity"));
}

TEST_CASE("numbers in words") {
  CHECK(ordinal(2) == "2nd");
  CHECK(ordinal(3) == "3rd");
  CHECK(ordinal(4) == "4th");
  CHECK(ordinal(11) == "11th");
  CHECK(ordinal(12) == "12th");
  CHECK(ordinal(21) == "21st");
  CHECK(ordinal(112) == "112th");
}
