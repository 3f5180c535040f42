#include "udar/results/checkpoint_file.hpp"

#include <doctest/doctest.h>

#include "tests/results/scratch.hpp"

namespace udar {
namespace {

/// A checkpoint of three parts, one of them empty.
std::string example(const Scratch& folder) {
  CheckpointWriter file(folder / "checkpoint.bin");
  file.add("first", "some bytes");
  file.add("empty", "");
  file.add("third", std::string(300, '\0'));
  file.commit();
  return read_file(folder / "checkpoint.bin", 1 << 16);
}

std::string refusal_of(std::string bytes) {
  return message_of<OutputError>([&] { const CheckpointFile file(std::move(bytes)); });
}

}  // namespace

TEST_CASE("checkpoint file: parts come back") {
  const Scratch folder;
  CheckpointFile file(example(folder));
  const CheckpointFile moved(std::move(file));  // parts stay where they are
  CHECK(moved.part("first") == "some bytes");
  CHECK(moved.part("empty").empty());
  CHECK(moved.part("third") == std::string(300, '\0'));
  CHECK(message_of<OutputError>([&] { (void)moved.part("fourth"); }) == "its part `fourth` is missing");
}

TEST_CASE("checkpoint file: one that was cut off anywhere is refused") {
  const Scratch folder;
  const std::string bytes = example(folder);
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    CAPTURE(length);
    CHECK(refusal_of(bytes.substr(0, length)) != "");
  }
}

TEST_CASE("checkpoint file: every wrong bit is found") {
  const Scratch folder;
  const std::string bytes = example(folder);
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    std::string wrong = bytes;
    wrong[bit / 8] = static_cast<char>(static_cast<unsigned char>(wrong[bit / 8]) ^ (1U << bit % 8));
    CAPTURE(bit);
    CHECK(refusal_of(wrong) != "");
  }
}

TEST_CASE("checkpoint file: parts that are missing or there twice, and other files, are refused") {
  const Scratch folder;
  const std::string bytes = example(folder);
  constexpr std::size_t line = 18;
  constexpr std::size_t first = 16 + 5 + 10;
  CHECK(refusal_of(bytes.substr(0, line) + bytes.substr(line + first)) == "it is damaged: parts are missing");
  CHECK(refusal_of(bytes.substr(0, line + first) + bytes.substr(line)) == "it is damaged: a part is there twice");
  CHECK(refusal_of(bytes + "x") == "it is damaged: parts are missing");
  CHECK(refusal_of("udar checkpoint 2\n" + bytes.substr(line)) == "it is of another version of Udar");
  CHECK(refusal_of("<?xml version=\"1.0\"?>") == "it is not a checkpoint");
}

}  // namespace udar
