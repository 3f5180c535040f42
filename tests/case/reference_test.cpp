#include "udar/case/reference.hpp"

#include <doctest/doctest.h>

#include <cstdlib>
#include <fstream>
#include <iterator>

namespace udar {
namespace {

TEST_CASE("docs/case-file.md is current") {
  const std::string file = std::string(UDAR_SOURCE_DIR) + "/docs/case-file.md";
  if (std::getenv("UDAR_WRITE_DOCS") != nullptr) std::ofstream(file) << case_file_reference();
  std::ifstream stream(file);
  const std::string written{std::istreambuf_iterator<char>(stream), {}};
  const bool current = written == case_file_reference();
  CHECK_MESSAGE(current, "run the test program of case/ with UDAR_WRITE_DOCS=1");
}

TEST_CASE("keys are found by a part of their path, their meaning or their choice") {
  CHECK(keys_text("element_size").find("bodies.NAME.mesh.element_size  (shape = \"disc\")") != std::string::npos);
  CHECK(keys_text("COULOMB").find("obstacles.NAME.friction") != std::string::npos);
  CHECK(keys_text("tresca").find("materials.NAME.yield_stress") != std::string::npos);
  CHECK(keys_text("").find("observe.regions.polygon") != std::string::npos);
  CHECK(keys_text("yeild_stress") == "no key is about \"yeild_stress\"; did you mean `yield_stress`?\n");
}

}  // namespace
}  // namespace udar
