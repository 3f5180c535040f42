#include "udar/results/file.hpp"

#include <doctest/doctest.h>
#include <unistd.h>

#include <filesystem>

#include "tests/results/scratch.hpp"

using namespace udar;
namespace fs = std::filesystem;

TEST_CASE("a written file reads back and leaves nothing else") {
  const Scratch folder;
  const std::string bytes = std::string("a\0b", 3) + std::string(700000, 'x');
  write_file(folder / "a.txt", "old");
  write_file(folder / "a.txt", bytes);
  CHECK(read_file(folder / "a.txt", 1 << 20) == bytes);
  CHECK(std::distance(fs::directory_iterator(folder.path), fs::directory_iterator()) == 1);
}

TEST_CASE("a leftover temporary file does not stand in the way") {
  const Scratch folder;
  write_file(folder / "victim", "whole");
  fs::create_symlink(folder / "victim", folder / "a.txt.tmp");
  write_file(folder / "a.txt", "new");
  CHECK(read_file(folder / "a.txt", 100) == "new");
  CHECK(read_file(folder / "victim", 100) == "whole");
}

TEST_CASE("a missing folder and a special file are refused, with the name") {
  const Scratch folder;
  const std::string missing = message_of<OutputError>([&] { write_file(folder / "none/a.txt", "x"); });
  CHECK(contains(missing, "none/a.txt"));
  CHECK(contains(missing, "No such file"));
  CHECK(contains(message_of<OutputError>([&] { write_file(folder.path, "x"); }), "not a regular file"));
  fs::create_symlink(folder / "elsewhere", folder / "link");
  CHECK_THROWS_AS(write_file(folder / "link", "x"), OutputError);
  CHECK_THROWS_AS(AppendFile(folder / "link"), OutputError);
  CHECK_FALSE(fs::exists(folder / "elsewhere"));
}

TEST_CASE("a folder without permission is an error that says so") {
  if (::geteuid() == 0) return;  // root may write everywhere
  const Scratch folder;
  fs::permissions(folder.path, fs::perms::owner_read | fs::perms::owner_exec);
  CHECK(contains(message_of<OutputError>([&] { write_file(folder / "a", "x"); }), "you may not write there"));
  fs::permissions(folder.path, fs::perms::owner_all);
}

TEST_CASE("a file larger than asked for is refused") {
  const Scratch folder;
  write_file(folder / "a", "12345");
  CHECK(read_file(folder / "a", 5) == "12345");
  CHECK_THROWS_AS(read_file(folder / "a", 4), OutputError);
  CHECK_THROWS_AS(read_file(folder / "b", 4), OutputError);
  CHECK_THROWS_AS(read_file("/dev/zero", 1000), OutputError);
}

TEST_CASE("an appended file shows its text after flush") {
  const Scratch folder;
  AppendFile file(folder / "log.txt");
  file.write("one\n");
  CHECK(read_file(folder / "log.txt", 100) == "");
  file.flush();
  CHECK(read_file(folder / "log.txt", 100) == "one\n");
  file.write("two\n");
  file.close();
  file.close();
  CHECK(read_file(folder / "log.txt", 100) == "one\ntwo\n");
  CHECK_THROWS_AS(file.write("three"), OutputError);
}

TEST_CASE("an appended file that is moved or dropped keeps its text") {
  const Scratch folder;
  {
    AppendFile first(folder / "log.txt");
    first.write("one\n");
    AppendFile second;
    second = std::move(first);
    second.write("two\n");
  }
  CHECK(read_file(folder / "log.txt", 100) == "one\ntwo\n");
}

TEST_CASE("a full disk is reported, once, with its cure") {
  AppendFile file("/dev/full");
  file.write("x");
  const std::string text = message_of<OutputError>([&] { file.close(); });
  CHECK(contains(text, "/dev/full"));
  CHECK(contains(text, "No space left"));
  CHECK(contains(text, "--output"));
  CHECK_FALSE(file.is_open());
}

TEST_CASE("a full buffer reaches the full disk without a flush") {
  AppendFile file("/dev/full");
  CHECK_THROWS_AS(file.write(std::string(100000, 'x')), OutputError);
}
