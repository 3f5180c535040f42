#include "udar/study/estimate.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numeric>
#include <vector>

using namespace udar;

namespace {

/// f = limit + factor h^order at these sizes.
std::vector<double> power_law(double limit, double factor, double order, const std::vector<double>& sizes) {
  std::vector<double> values;
  for (const double h : sizes) values.push_back(limit + factor * std::pow(h, order));
  return values;
}

Estimate estimate(const std::vector<double>& values, const std::vector<double>& sizes = {4, 2, 1}, double zero = 0) {
  return estimate_limit(values, sizes, {.tolerance = 0.02, .zero = zero});
}

}  // namespace

TEST_CASE("a power law gives back its order and its limit, whatever the ratios") {
  for (const double order : {0.6, 1.0, 4.0 / 3, 2.0}) {
    for (const auto& sizes : {std::vector<double>{4, 2, 1}, {16, 4, 1}, {3, 2, 1}, {1, 0.7, 0.2}, {8, 4, 2, 1}}) {
      CAPTURE(order);
      const Estimate e = estimate(power_law(5, -0.1, order, sizes), sizes);
      CHECK(e.order == doctest::Approx(order).epsilon(1e-9));
      CHECK(e.extrapolated == doctest::Approx(5).epsilon(1e-9));
      const double rest = std::fabs(e.values.back() - 5);
      CHECK(e.error == doctest::Approx(1.25 * rest).epsilon(1e-9));  // Roache's factor
    }
  }
}

TEST_CASE("Celik's example") {
  // Celik et al. (2008), table 1: phi = 5.863, 5.972, 6.063 on 4500, 8000 and 18000 cells in the plane.
  const std::vector<double> sizes{1 / std::sqrt(4500.0), 1 / std::sqrt(8000.0), 1 / std::sqrt(18000.0)};
  const std::vector<double> values{5.863, 5.972, 6.063};
  const Estimate e = estimate(values, sizes);
  // The order satisfies their equation 5a.
  const double r21 = sizes[1] / sizes[2];
  const double r32 = sizes[0] / sizes[1];
  const double p = e.order;
  const double q = std::log((std::pow(r21, p) - 1) / (std::pow(r32, p) - 1));
  CHECK(p ==
        doctest::Approx(std::fabs(std::log((values[0] - values[1]) / (values[1] - values[2])) + q) / std::log(r21)));
  CHECK(p == doctest::Approx(1.53).epsilon(0.01));                 // as they print it
  CHECK(e.extrapolated == doctest::Approx(6.1685).epsilon(1e-4));  // theirs
  CHECK(e.error / 6.063 == doctest::Approx(0.022).epsilon(0.02));  // their GCI of 2.2 %
}

TEST_CASE("verdicts follow error bar and tolerance") {
  const auto verdict_of = [](double factor) { return estimate(power_law(1, factor, 1, {4, 2, 1})).verdict; };
  // The error bar is 1.25 factor; of 1 + factor the tolerance is 2 %.
  CHECK(verdict_of(0.0162) == "converged");
  CHECK(verdict_of(0.0164) == "converging");
  CHECK(verdict_of(0.5) == "converging");
}

TEST_CASE("what grows or scatters does not converge") {
  const Estimate grows = estimate({1, 2, 4});
  CHECK(grows.verdict == "not converging");
  CHECK(std::isnan(grows.error));
  CHECK(std::isnan(grows.extrapolated));
  CHECK(grows.reason.find("2 times") != std::string::npos);
  CHECK(estimate({1, 1.5, 1}).verdict == "not converging");
  CHECK(estimate({1, 1.1, 0.9}).verdict == "not converging");
  // Halving takes less than an eighth off the changes: the order is 0.1.
  CHECK(estimate(power_law(2, 1, 0.1, {4, 2, 1})).verdict == "not converging");
}

TEST_CASE("scatter that hardly matters is converged") {
  // The range is 0.006, three times that 0.018.
  const Estimate e = estimate({1, 1.003, 0.997});
  CHECK(e.verdict == "converged");
  CHECK(e.error == doctest::Approx(0.018));
  CHECK(estimate({1, 1.004, 0.996}).verdict == "not converging");
}

TEST_CASE("to and fro with smaller steps: the error bar is the range") {
  const Estimate e = estimate({4.96, 4.61, 4.87});
  CHECK(e.verdict == "converging");
  CHECK(e.error == doctest::Approx(0.35));
  CHECK(std::isnan(e.order));
  CHECK(estimate({1, 1.01, 1.005}).verdict == "converged");
}

TEST_CASE("orders beyond the usual ones get a larger bar") {
  const Estimate fast = estimate(power_law(1, 0.01, 4, {4, 2, 1}));
  CHECK(fast.order == doctest::Approx(4));
  // As of order 2, and three times: (f3 - f2) / 3 * 3.
  CHECK(fast.error == doctest::Approx(0.01 * (16 - 1)));
  const Estimate slow = estimate(power_law(1, 0.01, 0.4, {4, 2, 1}));
  CHECK(slow.order == doctest::Approx(0.4));
  CHECK(std::isnan(slow.extrapolated));
  const double range = 0.01 * (std::pow(4, 0.4) - 1);
  CHECK(slow.error == doctest::Approx(3 * std::min(0.01, range)));
}

TEST_CASE("zeros, equals and gaps") {
  CHECK(estimate({0, 0, 0}).verdict == "converged");
  const Estimate noise = estimate({1e-14, -3e-14, 2e-13}, {4, 2, 1}, 1e-12);
  CHECK(noise.verdict == "converged");
  CHECK(noise.reason == "zero to rounding");
  CHECK(estimate({1e-14, -3e-14, 2e-13}).verdict == "not converging");
  const Estimate same = estimate({7, 7 * (1 + 1e-13), 7});
  CHECK(same.verdict == "converged");
  CHECK(same.extrapolated == 7);
  CHECK(same.error < 1e-11);
  // A level that was not computed: the others count, with their sizes.
  const Estimate gap = estimate(power_law(3, 0.1, 1, {8, 4, 2, 1}), {8, 4, 2, 1});
  std::vector<double> values = power_law(3, 0.1, 1, {8, 4, 2, 1});
  values[1] = no_number;
  const Estimate without = estimate(values, {8, 4, 2, 1});
  CHECK(without.values.size() == 3);
  CHECK(without.order == doctest::Approx(gap.order));
  CHECK(without.extrapolated == doctest::Approx(3));
  for (const auto& few : {std::vector<double>{}, {1}, {no_number, 2, no_number}}) {
    CHECK(estimate(few).verdict == "unknown");
    CHECK(std::isnan(estimate(few).error));
  }
  const Estimate two = estimate({2, 1.5}, {2, 1});
  CHECK(two.verdict == "unknown");
  CHECK(two.error == doctest::Approx(1.5));  // three times the difference, as for order 1
  // The finest is nothing, the others are not.
  CHECK(estimate({4, 2, 0}).verdict == "not converging");
  CHECK(estimate({4, 1, 0}).verdict == "converging");
}

TEST_CASE("differences of histories are judged alike") {
  const auto judge = [](const std::vector<double>& differences) {
    const std::vector<double> sizes{8, 4, 2, 1};
    return estimate_norms(differences, std::span(sizes).last(differences.size() + 1), {.tolerance = 0.02});
  };
  const Estimate first = judge({0.08, 0.04});
  CHECK(first.order == doctest::Approx(1));
  CHECK(first.error == doctest::Approx(1.25 * 0.04));  // what is left is as much as the last change
  CHECK(first.verdict == "converging");
  CHECK(judge({0.5, 0.016, 0.004}).verdict == "converged");
  CHECK(judge({0.5, 0.016, 0.004}).order == doctest::Approx(2));
  CHECK(judge({0.1, 0.2}).verdict == "not converging");
  CHECK(judge({0.1, 0.095}).verdict == "not converging");
  CHECK(judge({0.1, 0}).verdict == "converged");
  CHECK(judge({0.1}).verdict == "unknown");
  CHECK(judge({no_number, 0.1}).verdict == "unknown");
  CHECK(judge({0.1, no_number}).verdict == "unknown");
  CHECK(judge({}).verdict == "unknown");
}

TEST_CASE("of two verdicts the worse one counts") {
  CHECK(worse("converged", "not converging") == "not converging");
  CHECK(worse("converging", "unknown") == "converging");
  CHECK(worse("", "converged") == "converged");
  CHECK(worse("unknown", "converged") == "unknown");
}
