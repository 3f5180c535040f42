#pragma once

#include <atomic>
#include <vector>

#include "udar/parallel/background.hpp"
#include "udar/verification/problem.hpp"

namespace udar::verification {

/// Which parts of the problems are run.
enum class Which { quick, all, only_long };

/// The problems with these names, in the order of the manual; all of them where there are no names. Parts that are not
/// asked for are left out, and problems that have no others. Throws UserError (usage) with the nearest name where one
/// is wrong.
std::vector<Problem> choose_problems(const std::vector<std::string>& names, Which which);

/// Runs problems beside the thread that makes it, several parts at a time.
class ProblemRuns {
 public:
  /// `cores`: parts at a time, each on one core.
  ProblemRuns(std::vector<Problem> problems, int cores);
  ProblemRuns(const ProblemRuns&) = delete;

  [[nodiscard]] std::size_t count() const { return problems_.size(); }
  /// The title and what else is known of a problem beforehand.
  [[nodiscard]] const Problem& problem(std::size_t k) const { return problems_[k]; }
  /// Are all of its parts done? Then `result` may be read.
  [[nodiscard]] bool is_done(std::size_t k) const { return left_[k].load(std::memory_order_acquire) == 0; }
  [[nodiscard]] const VerifiedProblem& result(std::size_t k) const { return results_[k]; }
  /// Is one of its parts at work?
  [[nodiscard]] bool is_running(std::size_t k) const { return begun_[k].load() && !is_done(k); }
  [[nodiscard]] std::size_t parts() const { return jobs_.size(); }
  [[nodiscard]] std::size_t parts_done() const { return parts_done_.load(); }
  /// Waits until all is done. Throws UserError (resources) where the system gave no threads.
  void finish() { background_.finish(); }
  /// Throws what `finish` would.
  void rethrow() { background_.rethrow(); }

 private:
  struct Job {
    std::size_t problem, part;
  };
  void work(std::size_t job);

  std::vector<Problem> problems_;
  std::vector<VerifiedProblem> results_;
  std::vector<Job> jobs_;
  std::vector<std::atomic<std::size_t>> left_;  ///< parts of each problem
  std::vector<std::atomic<bool>> begun_;
  std::atomic<std::size_t> parts_done_{0};
  Background background_;  ///< the last member: it works on the others
};

}  // namespace udar::verification
