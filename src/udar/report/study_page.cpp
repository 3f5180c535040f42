#include "udar/report/study_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>

#include "udar/base/error.hpp"
#include "udar/report/encode.hpp"
#include "udar/report/packed_run.hpp"
#include "udar/report/study_runs.hpp"
#include "udar/results/run_folder.hpp"
#include "udar/results/study.hpp"

namespace udar {
namespace {

namespace fs = std::filesystem;

bool is_file(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error);
}

/// What runs go without.
struct Lack {
  std::string sentence;
  std::string runs;  ///< their names
};

/// What several runs go without is said once.
void add_lack(std::vector<Lack>& lacks, const std::string& sentence, const std::string& run) {
  const auto at = std::find_if(lacks.begin(), lacks.end(), [&](const Lack& l) { return l.sentence == sentence; });
  if (at == lacks.end()) {
    lacks.push_back({sentence, run});
  } else {
    at->runs += ", " + run;
  }
}

/// The page of a study on its way.
class StudyPage {
 public:
  StudyPage(const fs::path& folder, const ReportOptions& options)
      : folder_(folder), options_(options), page_(page_to_fill(options)), study_(read_study(folder)) {}

  ReportInfo write() {
    find_runs();
    Json study = Json::parse(to_json(study_));
    const Json frame = described(study, Json::array());
    // For sentences on runs that turn out too large.
    std::size_t reserve = 0;
    for (const std::size_t r : shown_) reserve += 200 + safe_json(study_.runs[r].name).size();
    const std::size_t around = page_bytes(page_) + safe_json(frame).size() + reserve;
    if (around > options_.limit) {
      throw UserError(ExitCode::usage,
                      fmt::format("a page of {} cannot hold this study: {} are needed without any run",
                                  megabytes(options_.limit), megabytes(around)),
                      "give it more with --limit");
    }
    pack(options_.limit - around);
    Json runs = Json::array();
    ReportInfo info;
    std::vector<Lack> lacks;
    for (const std::size_t r : shown_) {
      const auto at = packed_.find(r);
      if (at == packed_.end()) continue;
      info.frames += at->second.frames;
      for (const std::string& sentence : at->second.left_out) add_lack(lacks, sentence, study_.runs[r].name);
      runs.push_back(std::move(at->second.description));
    }
    info.left_out = left_out_;
    for (const Lack& lack : lacks) info.left_out.push_back(lack.runs + ": " + lack.sentence);
    const std::string text = safe_json(described(study, std::move(runs)));
    info.path = options_.output.empty() ? folder_ / StudyFolder::page : options_.output;
    info.bytes = write_page(info.path, page_, text, blocks_);
    return info;
  }

 private:
  [[nodiscard]] Json described(const Json& study, Json runs) const {
    return {{"format", 1}, {"kind", "study"}, {"study", study}, {"runs", std::move(runs)}, {"left_out", left_out_}};
  }

  /// Which runs are shown; what is not there is told.
  void find_runs() {
    for (const std::size_t r : shown_runs(study_, most_shown_runs)) {
      const StudyRun& run = study_.runs[r];
      const fs::path folder = study_run_folder(folder_, run);
      if (folder.empty() || !is_run_folder(folder)) {
        left_out_.push_back(fmt::format("the folder of the run {} is missing: it is in the tables only", run.name));
        continue;
      }
      shown_.push_back(r);
      files_.emplace(r, find_run_files(folder));
    }
    const std::size_t done = study_.kind == "converge" ? mesh_levels(study_).size() : done_runs(study_).size();
    if (done > most_shown_runs) {
      left_out_.push_back(fmt::format("{} of {} {} are shown beside each other; all are in the tables", most_shown_runs,
                                      done, study_.kind == "converge" ? "meshes" : "runs"));
    }
  }

  /// Shares out the room: the smaller runs first, each an equal part of what is left; what they do not need is for the
  /// larger ones.
  void pack(std::size_t room) {
    std::vector<std::size_t> order = shown_;
    const auto numbers = [&](std::size_t r) {
      return static_cast<double>(study_.runs[r].elements) * static_cast<double>(files_.at(r).frames.size());
    };
    std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return numbers(a) < numbers(b); });
    for (std::size_t k = 0; k < order.size(); ++k) {
      const StudyRun& run = study_.runs[order[k]];
      const std::size_t share = room / (order.size() - k);
      const Json about{{"name", run.name}, {"report", is_file(study_run_folder(folder_, run) / RunFolder::report)}};
      const std::size_t more = safe_json(about).size();  // with its comma
      try {
        const RunRoom part{share - std::min(share, more), share / 3};
        PackedRun packed = pack_run(std::move(files_.at(order[k])), options_, part, blocks_);
        packed.description.update(about);
        room -= packed.bytes + more;
        packed_.emplace(order[k], std::move(packed));
      } catch (const RunTooLarge& too_large) {
        left_out_.push_back(fmt::format("the run {} is in the tables only: it needs {} of the page without any frame",
                                        run.name, megabytes(too_large.needed)));
      }
    }
  }

  fs::path folder_;
  const ReportOptions& options_;
  std::string_view page_;
  Study study_;
  std::vector<std::size_t> shown_;
  std::map<std::size_t, RunFiles> files_;
  std::map<std::size_t, PackedRun> packed_;
  Blocks blocks_;
  std::vector<std::string> left_out_;
};

}  // namespace

ReportInfo write_study_page(const fs::path& study, const ReportOptions& options) {
  try {
    return StudyPage(study, options).write();
  } catch (const ReportInterrupted&) {
    return {};
  }
}

}  // namespace udar
