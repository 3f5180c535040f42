// What is wrong in how bodies, their contact and what holds them belong together.

#include <doctest/doctest.h>

#include "tests/case/example.hpp"

namespace udar {
namespace {

std::string complaints_of_beam_and(std::string_view more) {
  try {
    read_case(std::string(short_beam) + "\n" + std::string(more), "bad.toml");
  } catch (const UserError& error) {
    return error.what();
  }
  return "";
}

constexpr std::string_view hammer = R"([bodies.hammer]
material = "steel"
rigid = true
mesh = { shape = "rectangle", size = ["4 cm", "2 cm"], at = ["0 cm", "20 cm"], element_size = "1 cm" }
)";

struct Bad {
  const char* name;
  std::string more;
  std::vector<std::string> said;
};

}  // namespace

TEST_CASE("a rigid body is a body; what it cannot have is refused") {
  CHECK(complaints_of_beam_and(hammer).empty());
  const std::string h(hammer);
  const Bad all[] = {
      {"word for truth",
       "[bodies.hammer]\nmaterial = \"steel\"\nrigid = \"yes\"\n" + h.substr(h.find("mesh")),
       {"wrong kind of value for `rigid`", "bad.toml:31:9", "true or false", "write it like true"}},
      {"held",
       h + "[supports.grip]\nbody = \"hammer\"\nnodes = { side = \"top\" }\nmove_x = \"0 m\"\n",
       {"the body \"hammer\" is rigid", "bad.toml:34:8", "make it one, with a velocity"}},
      {"stress asked for",
       h + "[[observe.elements]]\nname = \"e\"\nbody = \"hammer\"\nat = [\"1 cm\", \"21 cm\"]\n",
       {"the body \"hammer\" is rigid", "bad.toml:35:8", "observe one of its nodes instead"}},
      {"deforms at the start",
       h + "cosine_mode = { amplitude = [\"0 m/s\", \"1 m/s\"], wave_vector = [\"1 rad/m\", \"0 rad/m\"] }\n",
       {"a rigid body has one velocity and one spin", "bad.toml:33:15"}},
  };
  for (const Bad& bad : all) {
    const std::string text = complaints_of_beam_and(bad.more);
    CAPTURE(bad.name);
    CAPTURE(text);
    for (const std::string& part : bad.said) {
      CAPTURE(part);
      CHECK(text.find(part) != std::string::npos);
    }
  }
}

TEST_CASE("a body cannot be tied to itself; two bodies can") {
  const std::string pair =
      std::string(hammer) + "[[contact.pairs]]\nbody = \"beam\"\nother = \"hammer\"\ntouch = \"tied\"\n";
  CHECK(complaints_of_beam_and(pair).empty());
  const std::string text =
      complaints_of_beam_and("[[contact.pairs]]\nbody = \"beam\"\nother = \"beam\"\ntouch = \"tied\"\n");
  CAPTURE(text);
  for (const char* part : {"a body cannot be tied to itself", "bad.toml:32:9", "its mesh holds it together already",
                           "name two bodies, or leave the pair out"}) {
    CAPTURE(part);
    CHECK(text.find(part) != std::string::npos);
  }
}

}  // namespace udar
