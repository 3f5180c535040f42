#include "udar/results/run_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <system_error>
#include <tuple>

#include "udar/base/error.hpp"
#include "udar/results/file.hpp"
#include "udar/results/pvd.hpp"
#include "udar/results/run_folder.hpp"

namespace udar {
namespace {

namespace fs = std::filesystem;

bool is_file(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error);
}

/// Files that a run may leave, read one by one: what cannot be read is told and passed over.
class Reader {
 public:
  explicit Reader(RunFiles& run) : run_(run) {}

  std::string text(std::string_view name) {
    constexpr std::size_t most_bytes = std::size_t{1} << 26;
    std::string found;
    if (is_file(run_.folder / name)) attempt([&] { found = read_file(run_.folder / name, most_bytes); });
    return found;
  }

  void summary() {
    run_.summary_text = text(RunFolder::summary);
    if (run_.summary_text.empty()) {
      run_.troubles.emplace_back("summary.json is missing: the run was stopped before its end, or still runs");
      return;
    }
    try {
      run_.summary = summary_from_json(run_.summary_text);
    } catch (const OutputError& error) {
      run_.troubles.push_back(fmt::format("summary.json cannot be read: {}", error.what()));
      run_.summary_text.clear();
    }
  }

  void frames() {
    if (!is_file(run_.folder / RunFolder::fields_index)) return;
    std::vector<PvdEntry> entries;
    attempt([&] { entries = read_pvd(run_.folder / RunFolder::fields_index); });
    std::map<double, FrameFiles> by_time;
    for (const PvdEntry& entry : entries) {
      const fs::path file = run_.folder / entry.file;
      if (!is_file(file)) {
        run_.troubles.push_back(entry.file + " is missing");
        continue;
      }
      FrameFiles& frame = by_time[entry.time];
      frame.time = entry.time;
      (entry.part == 0 ? frame.bodies : frame.obstacles) = file;
    }
    for (auto& [time, frame] : by_time) {
      if (!frame.bodies.empty()) run_.frames.push_back(std::move(frame));
    }
  }

  void histories() {
    std::error_code error;
    for (fs::directory_iterator it(run_.folder / RunFolder::histories, error), end; !error && it != end;
         it.increment(error)) {
      if (it->path().extension() == ".csv" && is_file(it->path())) run_.histories.push_back(it->path());
    }
    std::set<std::string> bodies;  // last, since a heap has thousands
    if (run_.summary) {
      for (const BodySummary& body : run_.summary->bodies) bodies.insert(body.name);
    }
    const auto rank = [&](const fs::path& path) {
      const std::string name = path.stem().string();
      const bool observed = run_.summary && run_.summary->observed.contains(name);
      const int group = observed ? 0 : name == "energy" ? 1 : name == "momentum" ? 2 : bodies.contains(name) ? 4 : 3;
      // body_2 before body_10
      return std::tuple(group, name.size(), name);
    };
    std::sort(run_.histories.begin(), run_.histories.end(),
              [&](const fs::path& a, const fs::path& b) { return rank(a) < rank(b); });
  }

 private:
  template <class Read>
  void attempt(Read read) {
    try {
      read();
    } catch (const OutputError& error) {
      run_.troubles.emplace_back(error.what());
    }
  }

  RunFiles& run_;
};

}  // namespace

bool is_run_folder(const fs::path& folder) {
  constexpr std::array own{RunFolder::marker, RunFolder::summary, RunFolder::fields_index, RunFolder::resolved_case};
  return std::any_of(own.begin(), own.end(), [&](std::string_view name) { return is_file(folder / name); });
}

void check_run_folder(const fs::path& folder) {
  if (is_run_folder(folder)) return;
  std::error_code error;
  const bool there = fs::exists(folder, error);
  throw UserError(ExitCode::usage,
                  fmt::format("`{}` {}", folder.string(), there ? "is not the folder of a run" : "is not there"),
                  "name a folder that `udar run` has made, such as runs/short-beam");
}

std::string folder_name(const fs::path& folder) {
  std::error_code error;
  fs::path whole = fs::absolute(folder, error).lexically_normal();
  if (!whole.has_filename()) whole = whole.parent_path();
  return whole.filename().string();
}

std::string case_name_of(const RunFiles& run) {
  if (run.summary && !run.summary->case_name.empty()) return run.summary->case_name;
  // "case short-beam: 12800 elements", written when the run began.
  for (std::size_t begin = 0; begin < run.log.size();) {
    const std::size_t end = std::min(run.log.find('\n', begin), run.log.size());
    const std::string line = run.log.substr(begin, end - begin);
    const std::size_t colon = line.rfind(": ");
    if (line.starts_with("case ") && colon != std::string::npos && colon > 5) return line.substr(5, colon - 5);
    begin = end + 1;
  }
  return folder_name(run.folder);
}

RunFiles find_run_files(const fs::path& folder) {
  check_run_folder(folder);
  RunFiles run;
  run.folder = folder;
  Reader reader(run);
  run.case_text = reader.text(RunFolder::given_case);
  run.resolved_text = reader.text(RunFolder::resolved_case);
  run.log = reader.text(RunFolder::log);
  run.version = reader.text(RunFolder::version);
  while (!run.version.empty() && run.version.back() == '\n') run.version.pop_back();
  reader.summary();
  reader.frames();
  reader.histories();
  return run;
}

}  // namespace udar
