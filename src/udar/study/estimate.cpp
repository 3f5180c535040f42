#include "udar/study/estimate.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace udar {
namespace {

// The orders that Eca and Hoekstra (2014) take as they come out; beyond them a sequence is not in its asymptotic range
// and gets the larger factor of safety.
constexpr double least_order = 0.5;
constexpr double most_order = 2.1;
constexpr double no_order =
    0.2;  // so slow that it cannot be told from none: halving the size takes an eighth off the changes
constexpr double usual_order = 2;  // what triangles with linear displacements can reach
constexpr double safety = 1.25;    // Roache's factor with three levels
constexpr double doubt = 3;        // and where less is known

/// From three levels: sizes of the elements, relative, and what changes between them.
struct Triple {
  double coarse_ratio = 2;  ///< size of the coarsest over that of the middle one
  double fine_ratio = 2;
  double coarse_change = 0;  ///< middle value less coarsest one
  double fine_change = 0;

  /// The latter change over the former, each by how much the elements were refined: between -1 and 1 they shrink.
  [[nodiscard]] double shrinkage() const {
    return fine_change / coarse_change * (std::log(coarse_ratio) / std::log(fine_ratio));
  }
  /// Of the three values.
  [[nodiscard]] double range() const {
    return std::max({std::fabs(coarse_change), std::fabs(fine_change), std::fabs(coarse_change + fine_change)});
  }
};

/// p with f = f_0 + C h^p through all three, for changes of one sign that shrink: the equations 5 of Celik et al.
/// (2008), whose two sides are compared here as functions of p, since their fixed point need not attract.
double order_of(const Triple& t) {
  const double wanted = t.coarse_change / t.fine_change;
  const auto changes = [&](double p) {  // coarse over fine; it rises with p
    return std::pow(t.fine_ratio, p) * std::expm1(p * std::log(t.coarse_ratio)) /
           std::expm1(p * std::log(t.fine_ratio));
  };
  double low = 1e-9;
  double high = 1;
  constexpr double highest = 64;
  while (high < highest && changes(high) < wanted) high *= 2;
  constexpr int halvings = 60;
  for (int k = 0; k < halvings; ++k) {
    const double middle = 0.5 * (low + high);
    (changes(middle) < wanted ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// What is left beyond the finest level, and how sure that is.
struct Rest {
  double order = no_number;
  double change = 0;  ///< limit less finest value
  double error = 0;
};

Rest rest_of(const Triple& t) {
  Rest rest;
  rest.order = order_of(t);
  const bool usual = rest.order >= least_order && rest.order <= most_order;
  const double order = std::min(rest.order, usual_order);
  rest.change = t.fine_change / (std::pow(t.fine_ratio, order) - 1);
  rest.error = (usual ? safety : doubt) * std::fabs(rest.change);
  // Far from its asymptotic range the power law is a guess; the range of the data is none.
  if (rest.order < least_order) rest.error = std::min(rest.error, doubt * t.range());
  return rest;
}

std::string percent(double part) {
  return part < 0.1 ? fmt::format("{:.2g} %", 100 * part) : fmt::format("{:.0f} %", 100 * part);
}

void conclude(Estimate& e, double size, const Standard& standard) {
  const double part = e.error > 0 ? e.error / size : 0;
  const bool done = part <= standard.tolerance;
  e.verdict = done ? verdict::converged : verdict::converging;
  if (!e.reason.empty()) e.reason += "; ";
  e.reason += done ? fmt::format("error bar {}", percent(part))
                   : fmt::format("error bar {}, more than {}", percent(part), percent(standard.tolerance));
}

/// Changes that do not shrink say nothing about the limit, unless all of them hardly matter.
void judge_scatter(Estimate& e, const Triple& t, double size, const Standard& standard, std::string why) {
  if (doubt * t.range() <= standard.tolerance * size) {
    e.error = doubt * t.range();
    e.reason = why + ", but hardly matter";
    return conclude(e, size, standard);
  }
  e.verdict = verdict::not_converging;
  e.reason = std::move(why);
}

void judge(Estimate& e, const Triple& t, double size, const Standard& standard) {
  const double shrinkage = t.shrinkage();
  if (!(std::fabs(shrinkage) < 1)) {
    return judge_scatter(
        e, t, size, standard,
        fmt::format("the changes do not shrink: the last is {:.3g} times the one before", std::fabs(shrinkage)));
  }
  if (shrinkage < 0) {
    e.error = t.range();
    e.reason = "the values go to and fro; the error bar is their range";
    return conclude(e, size, standard);
  }
  const Rest rest = rest_of(t);
  e.order = rest.order;
  if (rest.order < no_order) {
    return judge_scatter(e, t, size, standard,
                         fmt::format("the changes hardly shrink: the last is {:.3g} times the one before", shrinkage));
  }
  if (!e.values.empty() && rest.order >= least_order) e.extrapolated = e.values.back() + rest.change;
  e.error = rest.error;
  if (rest.order > most_order) e.reason = "the order is beyond that of the method";
  if (rest.order < least_order) e.reason = "slowly";
  conclude(e, size, standard);
}

/// Two levels: a first order is assumed, and nothing is said.
void judge_pair(Estimate& e, double change, double ratio) {
  e.error = doubt * std::fabs(change) / (ratio - 1);
  e.verdict = verdict::unknown;
  e.reason = "two levels tell no order; the error bar is three times their difference, as for the first order";
}

}  // namespace

Estimate estimate_limit(std::span<const double> values, std::span<const double> sizes, const Standard& standard) {
  Estimate e;
  std::vector<double> size;
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (!std::isfinite(values[k])) continue;
    e.values.push_back(values[k]);
    size.push_back(sizes[k]);
  }
  const std::size_t n = e.values.size();
  e.verdict = verdict::unknown;
  if (n < 2) {
    e.reason = n == 0 ? "no level has it" : "a single level has it";
    return e;
  }
  for (std::size_t k = 0; k + 1 < n; ++k) {
    const double change = std::fabs(e.values[k + 1] - e.values[k]);
    e.differences.push_back(change == 0 ? 0 : change / std::fabs(e.values[k + 1]));
  }
  const std::span<const double> last = std::span(e.values).last(std::min<std::size_t>(n, 3));
  const double finest = std::fabs(last.back());
  const auto tiny = [&](double v) { return std::fabs(v) <= standard.zero; };
  if (std::all_of(last.begin(), last.end(), tiny)) {
    e.error = finest;
    e.verdict = verdict::converged;
    e.reason = "zero to rounding";
    return e;
  }
  const double range = *std::max_element(last.begin(), last.end()) - *std::min_element(last.begin(), last.end());
  constexpr double rounding = 1e-9;
  if (n >= 3 && range <= rounding * finest) {
    e.extrapolated = last.back();
    e.error = range;
    e.verdict = verdict::converged;
    e.reason = "the same in all levels, to rounding";
    return e;
  }
  if (n == 2) {
    judge_pair(e, last[1] - last[0], size[n - 2] / size[n - 1]);
    return e;
  }
  judge(e,
        {.coarse_ratio = size[n - 3] / size[n - 2],
         .fine_ratio = size[n - 2] / size[n - 1],
         .coarse_change = last[1] - last[0],
         .fine_change = last[2] - last[1]},
        finest, standard);
  return e;
}

Estimate estimate_norms(std::span<const double> differences, std::span<const double> sizes, const Standard& standard) {
  Estimate e;
  e.differences.assign(differences.begin(), differences.end());
  const std::size_t n = differences.size();
  e.verdict = verdict::unknown;
  if (n == 0 || !std::isfinite(differences.back())) {
    e.reason = "the two finest levels have nothing to compare";
    return e;
  }
  const double fine_ratio = sizes[n - 1] / sizes[n];
  if (differences.back() == 0) {
    e.error = 0;
    e.verdict = verdict::converged;
    e.reason = "the same in the two finest levels";
    return e;
  }
  if (n == 1 || !std::isfinite(differences[n - 2])) {
    judge_pair(e, differences.back(), fine_ratio);
    return e;
  }
  judge(e,
        {.coarse_ratio = sizes[n - 2] / sizes[n - 1],
         .fine_ratio = fine_ratio,
         .coarse_change = differences[n - 2],
         .fine_change = differences[n - 1]},
        1, standard);
  return e;
}

std::string worse(const std::string& a, const std::string& b) {
  const std::array<std::string_view, 5> order{"", verdict::converged, verdict::unknown, verdict::converging,
                                              verdict::not_converging};
  const auto rank = [&](const std::string& v) { return std::find(order.begin(), order.end(), v) - order.begin(); };
  return rank(a) < rank(b) ? b : a;
}

}  // namespace udar
