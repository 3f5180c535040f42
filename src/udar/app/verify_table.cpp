#include "udar/app/verify_table.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>

namespace udar {
namespace {

using Cells = std::array<std::string, 7>;

/// Characters, not bytes.
std::size_t letters(std::string_view text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80; }));
}

Cells cells_of(const CheckRow& row, bool named) {
  const CheckWords words = words_of(row);
  return {named ? row.what : "", row.setting, words.computed, words.exact, words.error, words.bound, words.verdict};
}

std::string rows_text(const std::vector<Cells>& rows) {
  std::array<std::size_t, 7> widths{};
  for (const Cells& cells : rows) {
    for (std::size_t i = 0; i < cells.size(); ++i) widths[i] = std::max(widths[i], letters(cells[i]));
  }
  std::string text;
  for (const Cells& cells : rows) {
    std::string line = "   ";
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (widths[i] > 0) line += " " + cells[i] + std::string(widths[i] - letters(cells[i]) + 1, ' ');
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  }
  return text;
}

std::string part_text(const VerifiedPart& part) {
  std::vector<Cells> rows{{"", "", "computed", "exact", "error", "bound", ""}};
  for (const auto& group : grouped(part)) {
    for (const CheckRow* row : group) rows.push_back(cells_of(*row, row == group.front()));
  }
  std::string text = fmt::format("  {}  ({:.2g} s)\n", part.name, part.seconds) + rows_text(rows);
  for (const std::string& note : part.notes) text += "    " + note + "\n";
  return text;
}

}  // namespace

std::string line_of(const VerifiedProblem& problem) {
  const CheckCount count = count_of(problem);
  return fmt::format("{:<5} {:<16} {:>4} of {:>3} checks hold {:>6.1f} s\n", count.held == count.all ? "ok" : "FAILS",
                     problem.id, count.held, count.all, seconds_of(problem));
}

std::string table_of(const VerifiedProblem& problem) {
  const CheckCount count = count_of(problem);
  std::string text = fmt::format("{}: {}\n", problem.id, problem.title);
  for (const VerifiedPart& part : problem.parts) text += part_text(part);
  return text + fmt::format("  {} of {} checks hold, {:.2g} s\n\n", count.held, count.all, seconds_of(problem));
}

std::string failures_of(const Verification& verification) {
  std::string text;
  for (const VerifiedProblem& problem : verification.problems) {
    for (const VerifiedPart& part : problem.parts) {
      std::vector<Cells> rows;
      for (const CheckRow& row : part.rows) {
        if (!row.holds) rows.push_back(cells_of(row, true));
      }
      if (!rows.empty()) text += fmt::format("FAILS: {}, {}\n", problem.id, part.name) + rows_text(rows);
    }
  }
  return text;
}

}  // namespace udar
