#pragma once

#include <filesystem>

#include "udar/report/report.hpp"

namespace udar {

/// At most so many runs stand beside each other in the page of a study.
inline constexpr std::size_t most_shown_runs = 6;

/// Turns the folder of a study into one file that shows it, all or nothing: study.html there, unless the options say
/// otherwise. Runs share the limit of size: the small ones get what they need, the rest is for the large ones.
/// ReportInfo::frames are those of all runs. Throws as write_report, and OutputError where study.json cannot be read.
ReportInfo write_study_page(const std::filesystem::path& study, const ReportOptions& options = {});

}  // namespace udar
