#include "udar/case/case_file.hpp"

#include <string>
#include <vector>

#include "fuzz/target.hpp"
#include "udar/base/error.hpp"
#include "udar/case/build_model.hpp"
#include "udar/case/memory.hpp"

using namespace udar;

namespace {

/// A case that was read passes the checks of cases made in code, and is written so that the same case is read back.
void check_round_trip(const Case& c) {
  check_case(c);
  const std::string written = to_toml(c);
  fuzz::require(to_toml(read_case(written, "written.toml")) == written);
}

/// Small cases get their model, or a message.
void check_model(const Case& c) {
  constexpr double most_elements = 300;
  constexpr std::size_t most_bodies = 4;
  if (c.bodies.size() > most_bodies || elements_about(c) > most_elements) return;
  const Model model = build_model(c);
  fuzz::require(model.element_count > 0 && model.bodies.size() == c.bodies.size());
}

}  // namespace

/// The input is the text of a case file.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    std::vector<Diagnostic> warnings;
    const Case c = read_case(fuzz::text_of(data, size), "fuzz.toml", {}, &warnings);
    for (const Diagnostic& w : warnings) fuzz::require(fuzz::is_harmless(to_text(w)));
    check_round_trip(c);
    check_model(c);
  } catch (const UserError& error) {
    fuzz::require(!error.diagnostics.empty() && fuzz::is_harmless(error.what()));
  }
  return 0;
}
