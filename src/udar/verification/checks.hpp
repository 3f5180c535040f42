#pragma once

#include <limits>
#include <string>
#include <vector>

#include "udar/results/verification.hpp"

namespace udar {

/// From which errors an order is measured.
enum class OrderFrom {
  last_two,  ///< the two finest
  ends,      ///< the coarsest and the finest
  fit,       ///< a straight line through all, in logarithms
};

/// What an order of convergence is compared with.
struct OrderBound {
  double expected = std::numeric_limits<double>::quiet_NaN();  ///< by theory
  double least = 0;
  double most = std::numeric_limits<double>::infinity();
  OrderFrom from = OrderFrom::last_two;
};

/// The order p of errors ~ sizes^p. NaN where there are less than two, or one that is no positive number.
double order_of(const ErrorSeries& series, OrderFrom from = OrderFrom::last_two);

/// Takes down the checks of a part of a problem. A number that is not finite never holds, whatever it is compared with.
/// Every call tells whether the check holds; most have no use for it.
class Checks {
 public:
  explicit Checks(VerifiedPart& part) : part_(part) {}

  /// From now on rows are of this mesh, step or case: "50 cells". Rows with the same `what` and other settings stand
  /// together in the tables.
  void setting(std::string text) { setting_ = std::move(text); }

  /// |computed - exact| <= bound |exact|.
  bool within(const std::string& what, double computed, double exact, double bound, const std::string& unit = "");
  /// |computed - exact| <= bound, in the unit of both: where the exact value may be 0, or another scale matters.
  bool near(const std::string& what, double computed, double exact, double bound, const std::string& unit = "");
  /// computed == exact.
  bool equal(const std::string& what, double computed, double exact, const std::string& unit = "");
  /// computed <= bound: also for errors that are relative already.
  bool at_most(const std::string& what, double computed, double bound, const std::string& unit = "");
  /// computed < bound.
  bool below(const std::string& what, double computed, double bound, const std::string& unit = "");
  /// computed >= bound.
  bool at_least(const std::string& what, double computed, double bound, const std::string& unit = "");
  /// computed > bound.
  bool above(const std::string& what, double computed, double bound, const std::string& unit = "");
  /// low <= computed <= high.
  bool between(const std::string& what, double computed, double low, double high, const std::string& unit = "");
  /// The order in which errors fall; also draws them. Belongs to all settings.
  bool order(ErrorSeries series, const OrderBound& bound);
  /// Words that are true: an invariance, a count, a choice.
  bool holds(const std::string& what, bool is_true);

  /// Errors that are drawn, with the order of the last two, and not judged.
  void series(ErrorSeries series);
  /// Something computed that is drawn beside what is exact. Of long lines the extremes of short stretches are kept.
  void curve(CheckCurve curve);
  /// A sentence for the page.
  void note(std::string text) { part_.notes.push_back(std::move(text)); }
  /// A row of a table in the page of a shipped case, known there by its first cell: scripts/verification replaces it.
  void page_row(const std::string& first, const std::string& cells) {
    part_.page_rows.push_back("| " + first + " | " + cells + " |");
  }

 private:
  bool add(CheckRow row);

  VerifiedPart& part_;
  std::string setting_;
};

}  // namespace udar
