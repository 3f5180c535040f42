#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "tests/base/lanes/pack_checks.hpp"

namespace udar {
namespace {

struct Named {
  std::string name;
  PackChecks checks;
};

/// Those that this processor can run.
std::vector<Named> checks_here() {
  std::vector<Named> found{{"baseline", baseline::pack_checks()}};
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2")) found.push_back({"avx2", avx2::pack_checks()});
  if (__builtin_cpu_supports("avx512f")) found.push_back({"avx512", avx512::pack_checks()});
#endif
  return found;
}

}  // namespace

TEST_CASE("a pack has as many lanes as a register of its instruction set") {
  int lanes = 2;
  for (const Named& isa : checks_here()) {
    CHECK(isa.checks.lanes == lanes);
    lanes *= 2;
  }
}

TEST_CASE("packs compute what doubles compute, signed zeros, infinities and NaN included") {
  for (const Named& isa : checks_here()) {
    CAPTURE(isa.name);
    CHECK(std::string(isa.checks.packs()) == "");
  }
}

TEST_CASE("records and columns, pairs and lanes") {
  for (const Named& isa : checks_here()) {
    CAPTURE(isa.name);
    CHECK(std::string(isa.checks.transpose()) == "");
  }
}

}  // namespace udar
