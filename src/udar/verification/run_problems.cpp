#include "udar/verification/run_problems.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "udar/base/error.hpp"
#include "udar/base/text.hpp"
#include "udar/parallel/for_each.hpp"

namespace udar::verification {
namespace {

void check_names(const std::vector<Problem>& all, const std::vector<std::string>& names) {
  std::vector<std::string> known;
  for (const Problem& problem : all) known.push_back(problem.id);
  std::vector<Diagnostic> mistakes;
  for (const std::string& name : names) {
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    const std::string near = nearest_word(name, known);
    Diagnostic& mistake = mistakes.emplace_back();
    mistake.message = fmt::format("there is no problem `{}`", name);
    mistake.cure = near.empty() ? "`udar verify --list` shows all" : fmt::format("did you mean `{}`?", near);
  }
  if (!mistakes.empty()) throw UserError(ExitCode::usage, std::move(mistakes));
}

}  // namespace

std::vector<Problem> choose_problems(const std::vector<std::string>& names, Which which) {
  std::vector<Problem> chosen = all_problems();
  check_names(chosen, names);
  std::erase_if(chosen, [&](const Problem& problem) {
    return !names.empty() && std::find(names.begin(), names.end(), problem.id) == names.end();
  });
  for (Problem& problem : chosen) {
    std::erase_if(problem.parts,
                  [&](const Part& part) { return part.is_long ? which == Which::quick : which == Which::only_long; });
  }
  std::erase_if(chosen, [](const Problem& problem) { return problem.parts.empty(); });
  return chosen;
}

ProblemRuns::ProblemRuns(std::vector<Problem> problems, int cores)
    : problems_(std::move(problems)), left_(problems_.size()), begun_(problems_.size()) {
  for (std::size_t k = 0; k < problems_.size(); ++k) {
    const Problem& problem = problems_[k];
    results_.push_back({.id = problem.id,
                        .title = problem.title,
                        .topic = std::string(title_of(problem.topic)),
                        .text = problem.text,
                        .parts = std::vector<VerifiedPart>(problem.parts.size())});
    left_[k] = problem.parts.size();
    for (std::size_t part = 0; part < problem.parts.size(); ++part) jobs_.push_back({k, part});
  }
  background_.add([this, cores] {
    Pool pool(std::min(cores, static_cast<int>(std::max<std::size_t>(jobs_.size(), 1))));
    pool.for_each_job(jobs_.size(), [this](std::size_t job) { work(job); });
  });
}

void ProblemRuns::work(std::size_t job) {
  const auto [k, part] = jobs_[job];
  begun_[k] = true;
  results_[k].parts[part] = run_part(problems_[k].parts[part]);
  parts_done_.fetch_add(1);
  left_[k].fetch_sub(1, std::memory_order_acq_rel);
}

}  // namespace udar::verification
