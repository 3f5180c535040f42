#include "udar/results/run_folder.hpp"

#include <doctest/doctest.h>

#include "tests/results/scratch.hpp"
#include "udar/results/file.hpp"

using namespace udar;
namespace fs = std::filesystem;

namespace {

/// A run folder with results and with files of the user's own.
void make_run(const fs::path& path) {
  const RunFolder run = create_run_folder(path, false);
  write_file(run / RunFolder::summary, "{}");
  write_file(run / "summary.json.tmp", "left by a killed run");
  write_file(run.history("corner"), "time [s]\n");
  write_file(run / RunFolder::frame_name("bodies", 7), "frame");
  write_file(run / "notes.md", "mine");
  write_file(run / "data.csv", "mine");
  write_file(run / "fields/view.pvsm", "mine");
  fs::create_directory(run / "fields/odd.vtu");
}

}  // namespace

TEST_CASE("a new folder is made with its sub-folders, also in an empty one") {
  const Scratch scratch;
  const RunFolder run = create_run_folder(scratch / "a/b/run", false);
  CHECK(fs::is_directory(run / RunFolder::fields));
  CHECK(fs::is_directory(run / RunFolder::histories));
  fs::create_directory(scratch / "empty");
  CHECK_NOTHROW(create_run_folder(scratch / "empty", false));
}

TEST_CASE("a folder of a run that was killed in its first moment is as good as an empty one") {
  const Scratch scratch;
  for (const char* left : {".udar-run.tmp", ".udar-run"}) {
    const fs::path folder = scratch / (std::string("killed") + left);
    fs::create_directory(folder);
    write_file(folder / left, "");
    CHECK_NOTHROW(create_run_folder(folder, false));
  }
}

TEST_CASE("a run folder that is a link is neither made nor taken up again") {
  const Scratch scratch;
  create_run_folder(scratch / "run", false);
  fs::create_directory_symlink(scratch / "run", scratch / "link");
  CHECK(contains(message_of<UserError>([&] { create_run_folder(scratch / "link", true); }), "is a link"));
  CHECK(contains(message_of<UserError>([&] { reopen_run_folder(scratch / "link"); }), "is a link"));
}

TEST_CASE("results are not replaced without force") {
  const Scratch scratch;
  make_run(scratch / "run");
  const std::string text = message_of<UserError>([&] { create_run_folder(scratch / "run", false); });
  CHECK(contains(text, "holds the results of another run"));
  CHECK(contains(text, "--force"));
  CHECK(contains(text, "--output"));
  CHECK(fs::exists(scratch / "run/summary.json"));
}

TEST_CASE("force removes what a run wrote and nothing else") {
  const Scratch scratch;
  make_run(scratch / "run");
  create_run_folder(scratch / "run", true);
  for (const char* own : {"summary.json", "summary.json.tmp", "histories/corner.csv", "fields/bodies_000007.vtu"}) {
    CHECK_FALSE(fs::exists(scratch / "run" / own));
  }
  for (const char* foreign : {"notes.md", "data.csv", "fields/view.pvsm", "fields/odd.vtu"}) {
    CHECK(fs::exists(scratch / "run" / foreign));
  }
}

TEST_CASE("a folder that is not a run is refused even with force") {
  const Scratch scratch;
  write_file(scratch / "case.toml", "the user's only copy");
  for (const bool force : {false, true}) {
    const std::string text = message_of<UserError>([&] { create_run_folder(scratch.path, force); });
    CHECK(contains(text, "not the results of a run"));
  }
  CHECK(read_file(scratch / "case.toml", 100) == "the user's only copy");
  CHECK(contains(message_of<UserError>([&] { create_run_folder(scratch / "case.toml", true); }), "is not a folder"));
}

TEST_CASE("links are removed, never followed") {
  const Scratch scratch;
  fs::create_directory(scratch / "precious");
  write_file(scratch / "precious/a.vtu", "keep");
  write_file(scratch / "precious/b.json", "keep");
  make_run(scratch / "run");
  fs::remove(scratch / "run/summary.json");
  fs::create_symlink(scratch / "precious/b.json", scratch / "run/summary.json");
  create_run_folder(scratch / "run", true);
  CHECK_FALSE(fs::exists(fs::symlink_status(scratch / "run/summary.json")));
  CHECK(read_file(scratch / "precious/b.json", 10) == "keep");

  fs::remove_all(scratch / "run/fields");
  fs::create_directory_symlink(scratch / "precious", scratch / "run/fields");
  CHECK(contains(message_of<UserError>([&] { create_run_folder(scratch / "run", true); }), "is a link"));
  CHECK(read_file(scratch / "precious/a.vtu", 10) == "keep");
}

TEST_CASE("no name leads out of the run folder") {
  CHECK(safe_name("corner") == "corner");
  CHECK(safe_name("../../etc/passwd") == "_.._.._etc_passwd");
  CHECK(safe_name("-rf *\n") == "_-rf___");
  CHECK(safe_name("") == "_");
  CHECK(RunFolder{"run"}.history("a/b") == fs::path("run/histories/a_b.csv"));
  CHECK(RunFolder::frame_name("bodies", 42) == "fields/bodies_000042.vtu");
}
