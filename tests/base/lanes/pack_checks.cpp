// Compiled once for each instruction set (tests/CMakeLists.txt).

#include "pack_checks.hpp"

#include "udar/base/transpose.hpp"

namespace udar::UDAR_ISA {
namespace {

constexpr int width = Pack::lanes;

/// Everything that is treated in a way of its own somewhere.
const double odd_values[] = {
    0.0,     -0.0,    1.0,       -1.0, __builtin_nan(""), -__builtin_nan(""), __builtin_inf(), -__builtin_inf(), 5e-324,
    -5e-324, 1.7e308, 0x1p-1022, 2.0};
constexpr int odd_count = sizeof odd_values / sizeof odd_values[0];

unsigned long long bits_of(double value) {
  unsigned long long bits;
  __builtin_memcpy(&bits, &value, sizeof bits);
  return bits;
}
bool same_bits(double a, double b) { return bits_of(a) == bits_of(b); }
/// For results of arithmetic: which of its many bits a new NaN has is nobody's business.
bool same(double a, double b) { return same_bits(a, b) || (a != a && b != b); }

/// A pair of operands for each lane; `round` takes them through all pairs.
struct Operands {
  double a[width], b[width];

  explicit Operands(int round) {
    for (int lane = 0; lane < width; ++lane) {
      const int pair = round + lane;
      a[lane] = odd_values[pair % odd_count];
      b[lane] = odd_values[pair / odd_count % odd_count];
    }
  }
};

/// Does `packed` hold what `scalar` gives for the operands of each lane?
template <class Scalar, class Same>
bool holds(Pack packed, const Operands& x, Scalar scalar, Same same_values) {
  double got[width];
  packed.store(got);
  for (int lane = 0; lane < width; ++lane) {
    if (!same_values(got[lane], scalar(x.a[lane], x.b[lane]))) return false;
  }
  return true;
}

const char* fault_of_choices(const Operands& x) {
  const Pack a = Pack::load(x.a);
  const Pack b = Pack::load(x.b);
  const auto exactly = [&](Pack packed, auto scalar) { return holds(packed, x, scalar, same_bits); };
  if (!exactly(a, [](double p, double) { return p; })) return "load, store";
  if (!exactly(larger(a, b), [](double p, double q) { return udar::larger(p, q); })) return "larger";
  if (!exactly(smaller(a, b), [](double p, double q) { return udar::smaller(p, q); })) return "smaller";
  if (!exactly(select(a > b, a, b), [](double p, double q) { return udar::select(p > q, p, q); })) return "select >";
  if (!exactly(select(a < b, b, a), [](double p, double q) { return udar::select(p < q, q, p); })) return "select <";
  if (!exactly(fabs(a), [](double p, double) { return __builtin_fabs(p); })) return "fabs";
  return "";
}

const char* fault_of_arithmetic(const Operands& x) {
  const Pack a = Pack::load(x.a);
  const Pack b = Pack::load(x.b);
  const auto rounded = [&](Pack packed, auto scalar) { return holds(packed, x, scalar, same); };
  if (!rounded(a + b, [](double p, double q) { return p + q; })) return "+";
  if (!rounded(a - b, [](double p, double q) { return p - q; })) return "-";
  if (!rounded(a * b, [](double p, double q) { return p * q; })) return "*";
  if (!rounded(a / b, [](double p, double q) { return p / q; })) return "/";
  if (!rounded(-a, [](double p, double) { return -p; })) return "minus";
  if (!rounded(sqrt(a), [](double p, double) { return __builtin_sqrt(p); })) return "sqrt";
  return "";
}

const char* fault_of_masks(const Operands& x) {
  const Pack a = Pack::load(x.a);
  const Pack b = Pack::load(x.b);
  unsigned above = 0;
  unsigned below = 0;
  for (int lane = 0; lane < width; ++lane) {
    // Not as a shifted condition, of which g++ 12 makes another number under its sanitizers.
    if (x.a[lane] > x.b[lane]) above |= 1U << lane;
    if (x.a[lane] < x.b[lane]) below |= 1U << lane;
  }
  if (bits(a > b) != above) return "bits of >";
  if (bits(a < b) != below) return "bits of <";
  if (any(a > b) != (above != 0)) return "any";
  return "";
}

/// A pack made of one number has its bits in every lane.
const char* fault_of_constants() {
  for (const double value : odd_values) {
    double got[width];
    Pack(value).store(got);
    for (const double lane : got) {
      if (!same(lane, value)) return "a pack of one number";
    }
  }
  return "";
}

/// All combinations of lanes that a mask can have.
const char* fault_of_mask_lanes() {
  for (unsigned wanted = 0; wanted < 1U << width; ++wanted) {
    double a[width], got[width];
    for (int lane = 0; lane < width; ++lane) a[lane] = (wanted >> lane & 1) != 0 ? 1 : -1;
    const auto mask = Pack::load(a) > Pack(0);
    if (bits(mask) != wanted) return "bits of a mask";
    if (any(mask) != (wanted != 0)) return "any of a mask";
    select(mask, Pack(3), Pack(4)).store(got);
    for (int lane = 0; lane < width; ++lane) {
      if (got[lane] != ((wanted >> lane & 1) != 0 ? 3 : 4)) return "select of a mask";
    }
  }
  return "";
}

const char* check_packs() {
  for (int round = 0; round < odd_count * odd_count; ++round) {
    const Operands x(round);
    const char* const faults[] = {fault_of_choices(x), fault_of_arithmetic(x), fault_of_masks(x)};
    for (const char* fault : faults) {
      if (*fault != 0) return fault;
    }
  }
  const char* const faults[] = {fault_of_constants(), fault_of_mask_lanes()};
  for (const char* fault : faults) {
    if (*fault != 0) return fault;
  }
  return "";
}

/// Number `k` of record `r`: no two alike.
double number(int r, int k) { return 10 * r + k + 1; }

const char* check_records() {
  // Records backwards, with a gap of one number between them that must stay.
  constexpr int size = 5 * width;
  double from[size] = {};
  double to[size] = {};
  const auto in = [](double* memory) { return [memory](int r) { return memory + 5 * (width - 1 - r); }; };
  for (int r = 0; r < width; ++r) {
    for (int k = 0; k < 4; ++k) in(from)(r)[k] = number(r, k);
  }
  const Records read = load_records(in(from));
  const Columns packed = columns(read);
  for (int k = 0; k < 4; ++k) {
    double got[width];
    packed.at[k].store(got);
    for (int r = 0; r < width; ++r) {
      if (got[r] != number(r, k)) return "columns of records";
    }
  }
  store_records(records(packed), in(to));
  for (int k = 0; k < size; ++k) {
    if (to[k] != from[k]) return "records of columns";
  }
  const Records minus = records({{-packed.at[0], -packed.at[1], -packed.at[2], -packed.at[3]}});
  store_records(read - minus, in(to));
  for (int k = 0; k < size; ++k) {
    if (to[k] != 2 * from[k]) return "a difference of records";
  }
  return "";
}

const char* check_pairs() {
  double pairs[2 * width], x[width], y[width], again[2 * width];
  for (int k = 0; k < 2 * width; ++k) pairs[k] = 1 + k;
  Pack xs, ys, first, second;
  split_pairs(Pack::load(pairs), Pack::load(pairs + width), xs, ys);
  xs.store(x);
  ys.store(y);
  for (int lane = 0; lane < width; ++lane) {
    if (x[lane] != pairs[2 * lane] || y[lane] != pairs[2 * lane + 1]) return "split_pairs";
  }
  join_pairs(xs, ys, first, second);
  first.store(again);
  second.store(again + width);
  for (int k = 0; k < 2 * width; ++k) {
    if (again[k] != pairs[k]) return "join_pairs";
  }
  return "";
}

/// Lanes 0, 2, 4, ... of both packs in turn, and lanes 1, 3, 5, ...
const char* check_lanes() {
  double a[width], b[width], even[width], odd[width];
  for (int lane = 0; lane < width; ++lane) {
    a[lane] = 1 + lane;
    b[lane] = 101 + lane;
  }
  even_lanes(Pack::load(a), Pack::load(b)).store(even);
  odd_lanes(Pack::load(a), Pack::load(b)).store(odd);
  for (int lane = 0; lane < width; lane += 2) {
    if (even[lane] != a[lane] || even[lane + 1] != b[lane]) return "even_lanes";
    if (odd[lane] != a[lane + 1] || odd[lane + 1] != b[lane + 1]) return "odd_lanes";
  }
  return "";
}

const char* check_transpose() {
  const char* const faults[] = {check_records(), check_pairs(), check_lanes()};
  for (const char* fault : faults) {
    if (*fault != 0) return fault;
  }
  return "";
}

}  // namespace

PackChecks pack_checks() { return {width, check_packs, check_transpose}; }

}  // namespace udar::UDAR_ISA
