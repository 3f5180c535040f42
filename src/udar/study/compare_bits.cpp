#include <fmt/core.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <map>

#include "udar/results/file.hpp"
#include "udar/results/histories.hpp"
#include "udar/study/flat.hpp"
#include "udar/study/run_difference.hpp"

namespace udar {
namespace {

namespace fs = std::filesystem;

bool same_bytes(const fs::path& a, const fs::path& b) {
  constexpr std::size_t piece = std::size_t{1} << 20;
  const PartReader one(a);
  const PartReader two(b);
  if (one.size() != two.size()) return false;
  for (std::size_t at = 0; at < one.size(); at += piece) {
    if (one.read(at, piece) != two.read(at, piece)) return false;
  }
  return true;
}

bool same_double(double a, double b) { return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b); }

/// The first row that is not the same, of two files of which the bytes differ.
BitDifference first_row(const std::string& name, const History& a, const History& b) {
  BitDifference found{.same = false, .where = name, .how = "", .time = std::numeric_limits<double>::quiet_NaN()};
  if (a.columns != b.columns) {
    found.how = "other columns";
    return found;
  }
  const std::size_t rows_a = a.values.front().size();
  const std::size_t rows_b = b.values.front().size();
  const std::size_t rows = std::min(rows_a, rows_b);
  for (std::size_t r = 0; r < rows; ++r) {
    // The time last: a value tells more.
    for (std::size_t k = 1; k <= a.columns.size(); ++k) {
      const std::size_t c = k % a.columns.size();
      if (same_double(a.values[c][r], b.values[c][r])) continue;
      found.where = name + "." + a.columns[c].name;
      found.time = std::min(a.values[0][r], b.values[0][r]);
      return found;
    }
  }
  if (rows_a == rows_b) {
    found.how = "written in another way, or unfinished";
    return found;
  }
  found.how = rows_a < rows_b ? "ends earlier in A" : "ends earlier in B";
  found.time = (rows_a < rows_b ? b : a).values[0][rows];
  return found;
}

std::map<std::string, fs::path> by_name(const RunFiles& run) {
  std::map<std::string, fs::path> files;
  for (const fs::path& file : run.histories) files[file.stem().string()] = file;
  return files;
}

/// What differs between the histories; `same` where nothing does.
BitDifference compare_histories_bits(const RunFiles& a, const RunFiles& b) {
  const auto files_a = by_name(a);
  const auto files_b = by_name(b);
  BitDifference first{.same = true, .where = "", .how = ""};
  const auto offer = [&](BitDifference found) {
    const bool earlier = found.time < first.time || (first.time != first.time && found.time == found.time);
    if (first.same || earlier) first = std::move(found);
  };
  for (const fs::path& file : a.histories) {
    const std::string name = file.stem().string();
    const auto other = files_b.find(name);
    if (other == files_b.end()) {
      offer({.same = false, .where = "histories/" + name + ".csv", .how = "only in A"});
    } else if (!same_bytes(file, other->second)) {
      offer(first_row(name, read_csv(file), read_csv(other->second)));
    }
  }
  for (const auto& [name, file] : files_b) {
    if (!files_a.contains(name)) offer({.same = false, .where = "histories/" + name + ".csv", .how = "only in B"});
  }
  return first;
}

std::string name_in(const RunFiles& run, const fs::path& file) { return file.lexically_relative(run.folder).string(); }

BitDifference compare_frames(const RunFiles& a, const RunFiles& b) {
  const std::size_t both = std::min(a.frames.size(), b.frames.size());
  for (std::size_t k = 0; k < both; ++k) {
    const FrameFiles& one = a.frames[k];
    const FrameFiles& two = b.frames[k];
    const double time = std::min(one.time, two.time);
    if (!same_double(one.time, two.time)) {
      return {.same = false, .where = name_in(a, one.bodies), .how = "at another time", .time = time};
    }
    if (!same_bytes(one.bodies, two.bodies)) {
      return {.same = false, .where = name_in(a, one.bodies), .how = "", .time = time};
    }
    if (one.obstacles.empty() != two.obstacles.empty()) {
      return {.same = false, .where = name_in(a, one.bodies), .how = "obstacles in one of them only", .time = time};
    }
    if (!one.obstacles.empty() && !same_bytes(one.obstacles, two.obstacles)) {
      return {.same = false, .where = name_in(a, one.obstacles), .how = "", .time = time};
    }
  }
  if (a.frames.size() == b.frames.size()) return {.same = true, .where = "", .how = ""};
  const bool in_a = a.frames.size() > both;
  const RunFiles& longer = in_a ? a : b;
  const FrameFiles& frame = longer.frames[both];
  return {.same = false,
          .where = name_in(longer, frame.bodies),
          .how = in_a ? "only in A" : "only in B",
          .time = frame.time};
}

}  // namespace

BitDifference compare_bits(const RunFiles& a, const RunFiles& b) {
  BitDifference found = compare_histories_bits(a, b);
  if (found.same) found = compare_frames(a, b);
  if (!found.same) return found;
  if (a.summary_text.empty() != b.summary_text.empty()) {
    return {.same = false, .where = "summary.json", .how = a.summary_text.empty() ? "only in B" : "only in A"};
  }
  if (a.summary_text.empty()) return found;
  const std::string name = first_difference(flat_summary(a.summary_text), flat_summary(b.summary_text));
  if (name.empty()) return found;
  return {.same = false, .where = "summary.json: " + name, .how = ""};
}

}  // namespace udar
