#include "udar/report/program.hpp"

#include <doctest/doctest.h>

#include <fstream>

#include "tests/results/scratch.hpp"
#include "udar/base/error.hpp"
#include "udar/report/drawing.hpp"

using namespace udar;

namespace {

bool never() { return false; }

Program program(std::vector<std::string> words) {
  return {.words = std::move(words), .package = "some-package", .cure = "do without"};
}

}  // namespace

TEST_CASE("a program takes bytes and gives bytes, also more than a pipe holds, and words as they are") {
  std::string long_text;
  for (int k = 0; k < 300000; ++k) long_text += std::to_string(k) + "\n";
  CHECK(run_program(program({"cat"}), long_text) == long_text);
  CHECK(run_program(program({"cat"}), "") == "");
  CHECK(run_program(program({"printf", "%s|%s", "a b; $HOME", "`id`"}), "not read") == "a b; $HOME|`id`");
}

TEST_CASE("a program that is missing or fails is told with its cure or its last words") {
  const std::string missing = message_of<OutputError>([] { run_program(program({"no-such-program-7"}), ""); });
  CHECK(contains(missing, "`no-such-program-7` is not installed"));
  CHECK(contains(missing, "install the Debian package some-package, or do without"));
  CHECK_FALSE(is_installed(program({"no-such-program-7"})));
  CHECK(is_installed(program({"cat"})));
  const std::string failing = message_of<OutputError>([] {
    run_program(program({"sh", "-c", "echo first >&2; echo why >&2; exit 3"}), "x");
  });
  CHECK(contains(failing, "`sh` failed: why"));
  // One that does not read its input must not hang, nor its closed pipe end us.
  CHECK(
      contains(message_of<OutputError>([] { run_program(program({"false"}), std::string(1 << 20, 'x')); }), "failed"));
}

TEST_CASE("many runs of a program come back in order, whichever ends first") {
  const Program slow_first = program({"sh", "-c", "read n; [ $n = 0 ] && sleep 0.2; echo $n"});
  std::string all;
  std::size_t calls = 0;
  run_programs(
      slow_first, 7, 3, [](std::size_t k) { return std::to_string(k) + "\n"; },
      [&](std::size_t k, const std::string& output) {
        CHECK(k == calls++);
        all += output;
      },
      never);
  CHECK(all == "0\n1\n2\n3\n4\n5\n6\n");
}

TEST_CASE("an interrupt ends the programs that run") {
  const Scratch scratch;
  const std::string file = (scratch / "pid").string();
  const Program sleeper = program({"sh", "-c", "echo $$ > " + file + "; exec sleep 60"});
  CHECK_THROWS_AS(run_programs(
                      sleeper, 2, 1, [](std::size_t) { return std::string(); }, [](std::size_t, const std::string&) {},
                      [&] { return std::filesystem::exists(file) && std::filesystem::file_size(file) > 1; }),
                  Interrupted);
  int pid = 0;
  std::ifstream(file) >> pid;
  REQUIRE(pid > 0);
  CHECK_FALSE(std::filesystem::exists("/proc/" + std::to_string(pid)));
}

TEST_CASE("the ending says what a drawing becomes; svg needs no program") {
  CHECK(drawing_kind("a.svg") == DrawingKind::svg);
  CHECK(drawing_kind("b.c/a.pdf") == DrawingKind::pdf);
  CHECK_THROWS_AS(drawing_kind("a.jpg"), UserError);
  CHECK_THROWS_AS(drawing_kind("svg"), UserError);
  const Scratch scratch;
  write_drawing(scratch / "a.svg", "<svg/>", 0);
  CHECK(std::filesystem::file_size(scratch / "a.svg") == 6);
}
