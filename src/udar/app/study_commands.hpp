#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "udar/app/commands.hpp"
#include "udar/results/study.hpp"
#include "udar/study/plan.hpp"
#include "udar/study/run_all.hpp"

namespace udar {

/// What the commands that do many runs have in common.
struct StudyArguments {
  CaseArguments input;
  std::string output;  ///< empty: runs/<case>-<kind>
  std::vector<std::string> shown;
  int cores = 0;
  bool list = false;
  bool force = false;
  bool no_report = false;
};

void add_study_options(CLI::App& command, StudyArguments& arguments, const std::string& kind);

/// What a study is made of: its kind, its runs, and how the study follows from them.
struct StudyJob {
  std::string kind;  ///< converge or sweep
  std::vector<PlannedRun> plan;
  std::function<Study(const std::filesystem::path& folder, const std::vector<Standing>& standings)> conclude;
};

StudyInput study_input(const StudyArguments& arguments);

/// Does the runs that are missing, or lists them, and writes and prints what they say together.
ExitCode do_study(const StudyArguments& arguments, const StudyJob& job);

}  // namespace udar
