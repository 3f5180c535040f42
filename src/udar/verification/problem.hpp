#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "udar/case/case.hpp"
#include "udar/verification/checks.hpp"

namespace udar::verification {

/// Chapters of the manual, in their order.
enum class Topic { waves, vibration, plasticity, rotation, contact, friction, conservation, scheme, cases };

/// "Waves", as the title of a chapter.
std::string_view title_of(Topic topic);

/// What a problem checks at one go. Parts share nothing, and may run at the same time.
struct Part {
  std::string name;
  std::function<void(Checks&)> check;
  bool is_long = false;  ///< only with --long
};

/// A problem with an exact answer: a folder of verification/.
struct Problem {
  Topic topic = Topic::cases;
  std::vector<Part> parts;
  std::string id{};     ///< the name of the folder; set by all_problems
  std::string title{};  ///< from the first line of its README.md; set by all_problems
  std::string text{};   ///< the rest of it; set by all_problems
};

/// All of them, chapter by chapter.
std::vector<Problem> all_problems();

/// A case file that the program carries: "bar-on-wall/bar-on-wall.toml" of verification/, or one of cases/:
/// "cases/short-beam/short-beam.toml"; with changes as on the command line: "bodies.bar.mesh.element_size=1 mm".
/// Throws UserError.
Case load(const std::string& file, const std::vector<std::string>& changes = {});

/// Runs a part. What it throws becomes a check that fails.
VerifiedPart run_part(const Part& part);

// --- made by verification/CMakeLists.txt from the folders there

/// A problem before its page was read.
struct Registered {
  const char* id;
  Problem (*make)();
};
std::vector<Registered> registered_problems();

struct EmbeddedFile {
  std::string_view name;  ///< relative to verification/, or from cases/ on
  std::string_view text;
};
std::vector<EmbeddedFile> embedded_files();

}  // namespace udar::verification
