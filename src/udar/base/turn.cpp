#include "udar/base/vec2.hpp"

namespace udar {
namespace {

// pi/2 in three parts; the first two have 33 significant bits, so k * part is exact for k < 2^20 (Cody and Waite 1980).
constexpr double half_pi_1 = 0x1.921fb544p+0;
constexpr double half_pi_2 = 0x1.0b4611a6p-34;
constexpr double half_pi_3 = 0x1.3198a2e037073p-69;
constexpr double two_over_pi = 0x1.45f306dc9c883p-1;

// Taylor's series on |r| <= pi/4: the first omitted term is below 1e-18.
double sin_series(double r) {
  double sum = 0;
  for (int k = 17; k >= 3; k -= 2) sum = (1 + sum) * (-r * r / (k * (k - 1)));
  return r + r * sum;
}

double cos_series(double r) {
  double sum = 0;
  for (int k = 18; k >= 2; k -= 2) sum = (1 + sum) * (-r * r / (k * (k - 1)));
  return 1 + sum;
}

}  // namespace

Turn turn_by(double angle) {
  const double quadrant = std::floor(angle * two_over_pi + 0.5);
  const double r = ((angle - quadrant * half_pi_1) - quadrant * half_pi_2) - quadrant * half_pi_3;
  const double s = sin_series(r);
  const double c = cos_series(r);
  const double quarter = quadrant - 4 * std::floor(quadrant / 4);  // 0 to 3; exact, as all of it is whole
  if (quarter == 0) return {c, s};
  if (quarter == 1) return {-s, c};
  if (quarter == 2) return {-c, -s};
  return {s, -c};  // also of what is no number, which stays none
}

}  // namespace udar
