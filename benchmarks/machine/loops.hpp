#pragma once

#include <cstddef>
#include <cstdint>

namespace machine {

/// a[i] += s b[i]: 24 bytes each. Written lines were read before, as the solver's are, so nothing moves uncounted (of a
/// triad that writes to a third array the hardware first reads what will be overwritten). 2 reads to 1 write.
void triad(double* a, const double* b, std::size_t count, double s);
inline constexpr double triad_bytes = 24;

/// Independent multiplications and additions, as many of one as of the other; returns operations on doubles.
double multiply_and_add(std::uint64_t rounds);
/// The same fused, each counted as two; 0 where the processor has none. For information: the solver does not use them.
double fused(std::uint64_t rounds);

int lanes();

}  // namespace machine
