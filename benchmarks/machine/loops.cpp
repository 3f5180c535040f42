// Compiled for the processor that builds them.

#include "loops.hpp"

#include "udar/base/lanes.hpp"

namespace machine {
namespace {

using udar::UDAR_ISA::Pack;
using Vector = Pack::Vector;

/// Chains that a processor can work on at the same time: latency of an operation times operations begun in each clock,
/// and some more. Not more than fit the registers.
#if defined(__AVX512F__)
constexpr int chains = 24;
#else
constexpr int chains = 12;
#endif

/// Stands for a use of all chains, so that the compiler keeps them.
void use(const Vector (&chain)[chains]) {
  for (const Vector& v : chain) asm volatile("" : : "x"(v));
}

void begin(Vector (&chain)[chains]) {
  for (int c = 0; c < chains; ++c) chain[c] = Vector{} + (1 + 0.01 * c);
}

}  // namespace

int lanes() { return Pack::lanes; }

void triad(double* a, const double* b, std::size_t count, double s) {
  const Pack scale(s);
  for (std::size_t i = 0; i < count; i += Pack::lanes) {
    (Pack::load(a + i) + scale * Pack::load(b + i)).store(a + i);
  }
}

double multiply_and_add(std::uint64_t rounds) {
  Vector chain[chains];
  begin(chain);
  const Vector factor = Vector{} + 1.0000001, term = Vector{} + 1e-9;
  for (std::uint64_t n = 0; n < rounds; ++n) {
#pragma GCC unroll 24
    for (int c = 0; c < chains; c += 2) {
      chain[c] = chain[c] * factor;
      chain[c + 1] = chain[c + 1] + term;
    }
  }
  use(chain);
  return static_cast<double>(rounds) * chains * Pack::lanes;
}

double fused([[maybe_unused]] std::uint64_t rounds) {
#if defined(__FMA__)
  Vector chain[chains];
  begin(chain);
  const Vector factor = Vector{} + 0.9999999, term = Vector{} + 1e-9;
  for (std::uint64_t n = 0; n < rounds; ++n) {
#pragma GCC unroll 24
    for (int c = 0; c < chains; ++c) {
#if defined(__AVX512F__)
      chain[c] = _mm512_fmadd_pd(chain[c], factor, term);
#else
      chain[c] = _mm256_fmadd_pd(chain[c], factor, term);
#endif
    }
  }
  use(chain);
  return static_cast<double>(rounds) * chains * Pack::lanes * 2;
#else
  return 0;
#endif
}

}  // namespace machine
