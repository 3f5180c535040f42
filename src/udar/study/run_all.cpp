#include "udar/study/run_all.hpp"

#include <fmt/core.h>
#include <poll.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <deque>
#include <numeric>

#include "udar/base/error.hpp"
#include "udar/results/file.hpp"
#include "udar/results/run_folder.hpp"
#include "udar/results/study.hpp"
#include "udar/simulation/checkpoint.hpp"
#include "udar/simulation/simulation.hpp"
#include "udar/study/run_process.hpp"

namespace udar {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_text = std::size_t{1} << 26;

fs::path output_of(const fs::path& study, const PlannedRun& run) {
  return study / StudyFolder::runs / (run.name + ".txt");
}

/// The time of the last whole row of the history that every run has; 0 where there is none yet.
double time_reached(const fs::path& folder) {
  constexpr std::size_t a_row = 4096;
  try {
    const PartReader file(RunFolder{folder}.history("energy"));
    const std::size_t size = file.size();
    std::string tail = file.read(size > a_row ? size - a_row : 0, a_row);
    tail.erase(tail.rfind('\n') == std::string::npos ? 0 : tail.rfind('\n'));
    const std::size_t begin = tail.rfind('\n');
    double time = 0;
    const char* const first = tail.data() + (begin == std::string::npos ? 0 : begin + 1);
    std::from_chars(first, tail.data() + tail.size(), time);
    return time;
  } catch (const OutputError&) {
    return 0;
  }
}

/// What a run said last, without the word "error: ".
std::string last_words(const fs::path& output) {
  std::string text;
  try {
    text = read_file(output, most_text);
  } catch (const OutputError&) {
    return "it does not say why";
  }
  const std::size_t error = text.rfind("error: ");
  if (error == std::string::npos) return "it does not say why";
  text.erase(0, error + 7);
  return text.substr(0, text.find('\n'));
}

struct Running {
  std::size_t number = 0;  ///< in the plan
  int threads = 1;
  RunProcess process;
};

/// The runs that wait, those that go on, and how all stand.
class Queue {
 public:
  Queue(const StudyInput& input, const fs::path& study, const std::vector<PlannedRun>& plan,
        const RunAllOptions& options)
      : input_(input), study_(study), plan_(plan), options_(options), standings_(plan.size()) {
    for (std::size_t k = 0; k < plan.size(); ++k) {
      if (!options.again) standings_[k] = look_at(folder_of(k), plan[k]);
      if (standings_[k].state == Standing::State::missing) waiting_.push_back(k);
    }
    std::stable_sort(waiting_.begin(), waiting_.end(),
                     [&](std::size_t a, std::size_t b) { return plan[a].cost > plan[b].cost; });
  }

  [[nodiscard]] bool is_empty() const { return waiting_.empty() && running_.empty(); }
  [[nodiscard]] const std::vector<Standing>& standings() const { return standings_; }

  /// Begins runs as long as cores are free.
  void begin() {
    while (!waiting_.empty()) {
      const int threads = threads_for_next();
      if (threads > free_cores()) return;
      const std::size_t k = waiting_.front();
      waiting_.pop_front();
      const auto words = options_.again ? words_of(input_, study_, plan_[k], threads)
                                        : words_to_complete(input_, study_, plan_[k], threads);
      running_.push_back({k, threads, RunProcess(words, output_of(study_, plan_[k]))});
      standings_[k] = {.state = Standing::State::running, .reason = "", .summary = {}, .part = 0};
    }
  }

  void take_in_ended() {
    for (Running& run : running_) {
      const std::optional<int> code = run.process.ended();
      if (!code) continue;
      conclude(run.number, *code);
      run.threads = 0;
    }
    std::erase_if(running_, [](const Running& run) { return run.threads == 0; });
  }

  void look_at_progress() {
    for (const Running& run : running_) {
      standings_[run.number].part = std::min(1.0, time_reached(folder_of(run.number)) / plan_[run.number].end_time);
    }
  }

  /// Ends the runs in flight and forgets those that wait.
  void stop() {
    waiting_.clear();
    for (const Running& run : running_) run.process.interrupt();
  }

 private:
  [[nodiscard]] fs::path folder_of(std::size_t k) const { return study_ / StudyFolder::runs / plan_[k].name; }

  [[nodiscard]] int free_cores() const {
    return std::accumulate(running_.begin(), running_.end(), options_.cores,
                           [](int free, const Running& run) { return free - run.threads; });
  }

  /// The next run's part of the work that is left, in cores, as far as it has use for them: so all end at about the
  /// same time.
  [[nodiscard]] int threads_for_next() const {
    double left = 0;
    for (const std::size_t k : waiting_) left += plan_[k].cost;
    for (const Running& run : running_) left += plan_[run.number].cost * (1 - standings_[run.number].part);
    const PlannedRun& next = plan_[waiting_.front()];
    const auto share = static_cast<int>(std::lround(options_.cores * next.cost / left));
    const int useful = threads_for(static_cast<std::size_t>(next.elements));
    return std::clamp(std::min(share, useful), 1, std::max(1, options_.cores));
  }

  void conclude(std::size_t k, int code) {
    Standing& standing = standings_[k];
    standing = look_at(folder_of(k), plan_[k]);
    if (standing.state != Standing::State::missing) return;
    const bool stopped =
        code == static_cast<int>(ExitCode::interrupted) || code == static_cast<int>(ExitCode::terminated);
    if (stopped) {
      standing.reason = "stopped before its end";
    } else {
      standing.state = Standing::State::failed;
      standing.reason =
          code > 128 ? fmt::format("ended by signal {}", code - 128) : last_words(output_of(study_, plan_[k]));
    }
  }

  const StudyInput& input_;
  const fs::path& study_;
  const std::vector<PlannedRun>& plan_;
  const RunAllOptions& options_;
  std::vector<Standing> standings_;
  std::deque<std::size_t> waiting_;
  std::vector<Running> running_;
};

}  // namespace

Standing look_at(const fs::path& folder, const PlannedRun& run) {
  Standing standing{.state = Standing::State::missing, .reason = "not computed yet", .summary = {}, .part = 0};
  std::error_code error;
  if (!fs::exists(folder / RunFolder::resolved_case, error)) return standing;
  if (read_file(folder / RunFolder::resolved_case, most_text) != run.resolved) {
    throw UserError(ExitCode::usage, fmt::format("`{}` holds a run of another case", folder.string()),
                    "choose another folder with `--output`, or compute all runs again with `--force`");
  }
  Summary s;
  try {
    s = read_summary(folder / RunFolder::summary);
  } catch (const OutputError&) {
    return standing;  // killed, or it still runs
  }
  if (s.version != version_text()) {
    standing.reason = "computed by " + s.version;
    return standing;
  }
  if (s.stop_reason == "end_time") {
    standing.state = Standing::State::done;
    standing.reason = "";
    standing.part = 1;
  } else if (s.stop_reason == "numerical") {
    standing.state = Standing::State::failed;
    // The first line says what; its log has the rest.
    standing.reason =
        s.reasons.empty() ? "numerical failure" : s.reasons.front().substr(0, s.reasons.front().find('\n'));
    standing.part = s.end_time / run.end_time;
  } else {
    standing.reason = "stopped before its end";
    return standing;
  }
  standing.summary = std::move(s);
  return standing;
}

std::vector<std::string> words_of(const StudyInput& input, const fs::path& folder, const PlannedRun& run, int threads) {
  std::vector<std::string> words{"run", input.file.string()};
  for (const auto* list : {&input.assignments, &run.changes}) {
    for (const std::string& assignment : *list) {
      words.emplace_back("--set");
      words.push_back(assignment);
    }
  }
  words.insert(words.end(), {"--output", (folder / StudyFolder::runs / run.name).string(), "--force", "--no-report"});
  if (threads > 0) words.insert(words.end(), {"--threads", std::to_string(threads)});
  return words;
}

std::vector<std::string> words_to_complete(const StudyInput& input, const fs::path& folder, const PlannedRun& run,
                                           int threads) {
  const fs::path own = folder / StudyFolder::runs / run.name;
  try {
    std::vector<std::string> notes;
    if (newest_checkpoint(own, notes).run.case_text != run.resolved) return words_of(input, folder, run, threads);
  } catch (const UserError&) {
    return words_of(input, folder, run, threads);
  }
  std::vector<std::string> words{"resume", own.string(), "--no-report"};
  if (threads > 0) words.insert(words.end(), {"--threads", std::to_string(threads)});
  return words;
}

std::vector<Standing> run_all(const StudyInput& input, const fs::path& folder, const std::vector<PlannedRun>& plan,
                              const RunAllOptions& options) {
  Queue queue(input, folder, plan, options);
  bool stopping = false;
  int looks = 0;
  while (!queue.is_empty()) {
    if (!stopping && options.interrupted && options.interrupted()) {
      stopping = true;
      queue.stop();
    }
    queue.begin();
    constexpr int look_every = 20;  // ms
    ::poll(nullptr, 0, look_every);
    queue.take_in_ended();
    constexpr int looks_between_tells = 12;
    if (++looks % looks_between_tells != 0) continue;
    queue.look_at_progress();
    if (options.tell) options.tell(queue.standings());
  }
  if (options.tell) options.tell(queue.standings());
  return queue.standings();
}

}  // namespace udar
