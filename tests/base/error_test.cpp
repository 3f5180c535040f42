#include "udar/base/error.hpp"

#include <doctest/doctest.h>

using namespace udar;

TEST_CASE("a mistake is shown with its line, a caret and a cure") {
  const Diagnostic mistake{.file = "beam.toml",
                           .line = 14,
                           .column = 22,
                           .length = 7,
                           .source = R"(velocity = ["0 m/s", "-80 m"])",
                           .message = "wrong unit for `velocity`",
                           .pointer = "this is a length; a velocity is needed",
                           .cure = R"(did you mean "-80 m/s"?)"};
  CHECK(to_text(mistake) ==
        "error: wrong unit for `velocity`\n"
        "  --> beam.toml:14:22\n"
        "14 | velocity = [\"0 m/s\", \"-80 m\"]\n"
        "   |                      ^^^^^^^ this is a length; a velocity is needed\n"
        "   = did you mean \"-80 m/s\"?\n");
}

TEST_CASE("the margin grows with the line number") {
  const Diagnostic mistake{.file = "a.toml", .line = 7, .column = 1, .source = "x", .message = "unknown key `x`"};
  CHECK(to_text(mistake) ==
        "error: unknown key `x`\n"
        " --> a.toml:7:1\n"
        "7 | x\n"
        "  | ^\n");
}

TEST_CASE("the caret stands under its character after tabs and umlauts") {
  const Diagnostic mistake{.file = "a", .line = 1, .column = 4, .source = "\tü=x", .message = "m"};
  CHECK(to_text(mistake) == "error: m\n --> a:1:4\n1 | \tü=x\n  | \t  ^\n");
}

TEST_CASE("a mistake without a place has only reason and cure") {
  CHECK(to_text({.message = "no case given", .cure = "try udar run CASE"}) ==
        "error: no case given\n"
        "  = try udar run CASE\n");
  CHECK(to_text({.file = "a.toml", .message = "file is empty"}) ==
        "error: file is empty\n"
        " --> a.toml\n");
}

TEST_CASE("an error tells all mistakes at once and keeps its exit code") {
  const UserError error(ExitCode::bad_case, std::vector<Diagnostic>{{.message = "one"}, {.message = "two"}});
  CHECK(std::string(error.what()) == "error: one\nerror: two\n");
  CHECK(error.code == ExitCode::bad_case);
  CHECK(error.diagnostics.size() == 2);
  CHECK(UserError(ExitCode::usage, "what", "how").diagnostics[0].cure == "how");
}

TEST_CASE("exit codes never change") {
  CHECK(static_cast<int>(ExitCode::done) == 0);
  CHECK(static_cast<int>(ExitCode::internal) == 1);
  CHECK(static_cast<int>(ExitCode::usage) == 2);
  CHECK(static_cast<int>(ExitCode::bad_case) == 3);
  CHECK(static_cast<int>(ExitCode::bad_mesh) == 4);
  CHECK(static_cast<int>(ExitCode::numerical) == 5);
  CHECK(static_cast<int>(ExitCode::output) == 6);
  CHECK(static_cast<int>(ExitCode::resources) == 7);
  CHECK(static_cast<int>(ExitCode::checkpoint) == 8);
  CHECK(static_cast<int>(ExitCode::differs) == 9);
  CHECK(static_cast<int>(ExitCode::interrupted) == 130);
  CHECK(static_cast<int>(ExitCode::terminated) == 143);
}
