#pragma once

namespace udar {

/// Checks of base/lanes.hpp and base/transpose.hpp, compiled for each instruction set as the element sweep is. They
/// call nothing of a library, so that nothing of theirs leaks into the test program: no doctest, no containers. Each
/// returns the name of the first thing that is wrong, or "".
struct PackChecks {
  int lanes;                   ///< doubles in a pack
  const char* (*packs)();      ///< every function of a pack gives, lane by lane, the bits of its scalar overload
  const char* (*transpose)();  ///< records to columns and back, pairs split and joined, lanes picked
};

namespace baseline {
PackChecks pack_checks();
}
namespace avx2 {
PackChecks pack_checks();
}
namespace avx512 {
PackChecks pack_checks();
}

}  // namespace udar
