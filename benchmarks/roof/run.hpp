#pragma once

#include <cstdint>

#include "beam.hpp"

namespace roof {

/// What the check asks for.
struct Books {
  double plastic_work = 0;    ///< J
  std::uint64_t flowing = 0;  ///< element-steps in which the element flowed
};

/// One for each lane of a register: where among the forces on one corner of a group its force is stored.
std::vector<Index> slots_of_lanes();

/// Does so many steps and returns their wall time, s. With books it takes longer.
double run(Problem& problem, std::uint64_t steps, Books* books = nullptr);

}  // namespace roof
