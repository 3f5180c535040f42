#include "udar/report/verification_page.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>

#include "udar/base/error.hpp"
#include "udar/report/markdown.hpp"
#include "udar/report/verification_plots.hpp"
#include "udar/results/file.hpp"
#include "udar/results/xml.hpp"

namespace udar {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view readme = "/README.md";

/// "../hertz/README.md" leads to another problem: "#hertz"; "" otherwise.
std::string anchor_of(const std::string& target) {
  const bool problem = target.starts_with("../") && target.ends_with(readme) && !target.starts_with("../../");
  return problem ? "#" + target.substr(3, target.size() - 3 - readme.size()) : "";
}

/// Pages of problems stand two folders deep, the manual in docs/.
std::string from_docs(const std::string& target) {
  constexpr std::string_view docs = "../../docs/";
  if (std::string anchor = anchor_of(target); !anchor.empty()) return anchor;
  if (target.starts_with(docs)) return target.substr(docs.size());
  return target.starts_with("../../") ? target.substr(3) : target;
}

/// The page stands alone: only links to what it holds are kept.
std::string from_page(const std::string& target) { return target.starts_with("https://") ? target : anchor_of(target); }

std::string picture_name(const std::string& problem, std::size_t number) {
  return fmt::format("verification-{}-{}.svg", problem, number);
}

/// Which columns of a part's table have something in them.
using Columns = std::array<bool, 5>;

std::array<std::string, 5> cells_of(const CheckRow& row) {
  const CheckWords words = words_of(row);
  return {row.setting, words.computed, words.exact, words.error, words.bound};
}

Columns columns_of(const VerifiedPart& part) {
  Columns used{};
  for (const CheckRow& row : part.rows) {
    const auto cells = cells_of(row);
    for (std::size_t i = 0; i < cells.size(); ++i) used[i] = used[i] || !cells[i].empty();
  }
  return used;
}

constexpr std::array<const char*, 5> column_names{"with", "computed", "exact", "error", "bound"};

std::string machine_words(const Verification& v) {
  const std::string bounds = v.bounds == 1 ? "" : fmt::format(", bounds of errors times {}", v.bounds);
  return fmt::format("{}, {}, {} UTC, {}{}", v.version, v.processor.empty() ? "processor unknown" : v.processor, v.date,
                     v.cores == 1 ? "1 core" : fmt::format("{} cores", v.cores), bounds);
}

std::string count_words(const CheckCount& count) { return fmt::format("{} of {}", count.held, count.all); }

std::string seconds_words(double seconds) { return fmt::format("{:.{}f} s", seconds, seconds < 9.95 ? 1 : 0); }

// --- Markdown

std::string cell(std::string text) {
  for (std::size_t at = 0; (at = text.find('|', at)) != std::string_view::npos; at += 2) text.insert(at, "\\");
  return text;
}

std::string markdown_table(const VerifiedPart& part) {
  const Columns used = columns_of(part);
  std::string head = "| check |";
  std::string rule = "|---|";
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (!used[i]) continue;
    head += fmt::format(" {} |", column_names[i]);
    rule += i == 0 ? "---|" : "--:|";
  }
  std::string text = head + " |\n" + rule + "---|\n";
  for (const auto& group : grouped(part)) {
    for (const CheckRow* row : group) {
      text += "| " + (row == group.front() ? cell(row->what) : "") + " |";
      const auto cells = cells_of(*row);
      for (std::size_t i = 0; i < used.size(); ++i) {
        if (used[i]) text += " " + cell(cells[i]) + " |";
      }
      text += row->holds ? " holds |\n" : " **FAILS** |\n";
    }
  }
  return text;
}

std::string markdown_of(const VerifiedProblem& problem) {
  std::string text = fmt::format("### {}\n\n**{}.** {} checks hold, {}.\n\n{}\n", problem.id, problem.title,
                                 count_words(count_of(problem)), seconds_words(seconds_of(problem)),
                                 relinked(problem.text, from_docs));
  std::size_t number = 0;
  for (const VerifiedPart& part : problem.parts) {
    text += fmt::format("\n#### {}: {}{}\n\n", problem.id, part.name, part.is_long ? " (long)" : "");
    text += markdown_table(part);
    for (const std::string& note : part.notes) text += "\n" + note + "\n";
    for (const VerificationPlot& plot : verification_plots(part)) {
      text += fmt::format("\n![{}]({}/{})\n", plot.caption, VerificationFiles::pictures,
                          picture_name(problem.id, ++number));
    }
  }
  return text + "\n";
}

std::string problem_words(const Verification& v) {
  return v.problems.size() == 1 ? "1 problem" : fmt::format("{} problems", v.problems.size());
}

std::string markdown_contents(const Verification& v) {
  std::string text = "| problem | | checks that hold | time |\n|---|---|--:|--:|\n";
  for (const VerifiedProblem& problem : v.problems) {
    text += fmt::format("| [{0}](#{0}) | {1} | {2} | {3} |\n", problem.id, cell(problem.title),
                        count_words(count_of(problem)), seconds_words(seconds_of(problem)));
  }
  return text;
}

constexpr const char* explanation =
    "Each problem has an exact answer. Bounds come from the formula and from the order of the method, not from what "
    "came "
    "out. A relative error stands beside the exact value it belongs to; \"order\" is the power of the element size or "
    "of "
    "the step with which an error falls.";

// --- HTML

std::string html_table(const VerifiedPart& part) {
  const Columns used = columns_of(part);
  std::string text = "<table class=\"checks\">\n<tr><th>check</th>";
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (used[i]) text += fmt::format("<th>{}</th>", column_names[i]);
  }
  text += "<th></th></tr>\n";
  for (const auto& group : grouped(part)) {
    for (const CheckRow* row : group) {
      text += row == group.front() ? "<tr class=\"first\">" : "<tr>";
      text += "<td>" + (row == group.front() ? escape_xml(row->what) : "") + "</td>";
      const auto cells = cells_of(*row);
      for (std::size_t i = 0; i < used.size(); ++i) {
        if (used[i]) text += "<td>" + escape_xml(cells[i]) + "</td>";
      }
      text += row->holds ? "<td class=\"good\">holds</td></tr>\n" : "<td class=\"bad\">FAILS</td></tr>\n";
    }
  }
  return text + "</table>\n";
}

/// The picture within a page: without the pattern that plots do not use, whose name would stand there many times.
std::string inlined(const std::string& svg) {
  const std::size_t begin = svg.find("<defs>");
  const std::size_t end = svg.find("</defs>");
  if (begin == std::string::npos || end == std::string::npos) return svg;
  return svg.substr(0, begin) + svg.substr(end + std::string_view("</defs>\n").size());
}

std::string section_of(const VerifiedProblem& problem) {
  const CheckCount count = count_of(problem);
  std::string text =
      fmt::format("<section id=\"{0}\">\n<h3>{0}: {1}</h3>\n<p class=\"{2}\">{3} checks hold, {4}.</p>\n{5}",
                  escape_xml(problem.id), escape_xml(problem.title), count.held == count.all ? "good" : "bad",
                  count_words(count), seconds_words(seconds_of(problem)), html_of(problem.text, from_page));
  for (const VerifiedPart& part : problem.parts) {
    text += fmt::format("<h4>{}{}</h4>\n{}", escape_xml(part.name), part.is_long ? " (long)" : "", html_table(part));
    for (const std::string& note : part.notes) text += "<p>" + escape_xml(note) + "</p>\n";
    for (const VerificationPlot& plot : verification_plots(part)) {
      text += fmt::format("<figure aria-label=\"{}\">\n{}</figure>\n", escape_xml(plot.caption), inlined(plot.svg));
    }
  }
  return text + "</section>\n";
}

constexpr const char* style = R"(
:root { --paper: #ffffff; --back: #f4f6f8; --ink: #1d2733; --faint: #5b6672; --line: #d9dee4; --good: #1a6b3c; --bad: #a3230f; --link: #0b5a9c; }
@media (prefers-color-scheme: dark) { :root { --paper: #14191f; --back: #0d1115; --ink: #e4e9ee; --faint: #9aa6b2; --line: #2c353f;
  --good: #6fd39a; --bad: #ff8a75; --link: #7cc0ff; } }
* { box-sizing: border-box; }
body { margin: 0; background: var(--back); color: var(--ink);
  font: 15px/1.5 system-ui, "Segoe UI", Helvetica, Arial, "Liberation Sans", "DejaVu Sans", sans-serif; }
main { max-width: 1064px; margin: 0 auto; padding: 1rem; }
header, section { background: var(--paper); border: 1px solid var(--line); border-radius: 6px; padding: .6rem 1.2rem 1rem; margin-bottom: 1rem; }
h1 { font-size: 1.5rem; margin: .3rem 0; }
h2 { font-size: 1.25rem; margin: 1.6rem 0 .6rem; }
h3 { font-size: 1.15rem; margin: .3rem 0; }
h4 { margin: 1.4rem 0 .3rem; }
a { color: var(--link); }
code { font-size: .92em; background: var(--back); padding: 0 .2em; border-radius: 3px; }
pre { background: var(--back); padding: .6rem; overflow-x: auto; }
.good { color: var(--good); } .bad { color: var(--bad); font-weight: 600; }
.faint { color: var(--faint); }
table { border-collapse: collapse; font-size: .93rem; font-variant-numeric: tabular-nums; display: block; overflow-x: auto; }
th { color: var(--faint); font-weight: normal; border-bottom: 1px solid var(--line); text-align: left; }
th, td { padding: .1rem .7rem .1rem 0; vertical-align: top; }
.checks td:nth-child(n+2), .contents td:nth-child(n+3) { white-space: nowrap; }
tr.first td { border-top: 1px solid var(--line); }
figure { margin: 1rem 0; border: 1px solid var(--line); border-radius: 4px; overflow: hidden; background: #ffffff; }
figure svg { display: block; width: 100%; height: auto; }
@media print { header, section { border: none; } figure { break-inside: avoid; } }
)";

std::string html_contents(const Verification& v) {
  std::string text =
      "<table class=\"contents\">\n<tr><th>problem</th><th></th><th>checks that hold</th><th>time</th></tr>\n";
  for (const VerifiedProblem& problem : v.problems) {
    const CheckCount count = count_of(problem);
    text +=
        fmt::format("<tr><td><a href=\"#{0}\">{0}</a></td><td>{1}</td><td class=\"{2}\">{3}</td><td>{4}</td></tr>\n",
                    escape_xml(problem.id), escape_xml(problem.title), count.held == count.all ? "good" : "bad",
                    count_words(count), seconds_words(seconds_of(problem)));
  }
  return text + "</table>\n";
}

}  // namespace

std::string verification_markdown(const Verification& v) {
  std::string text = fmt::format(
      "# Verification\n\n<!-- Made by scripts/verification from a run of `udar verify --long`. -->\n\n{}\n\n**{} "
      "checks "
      "hold**, of {}, in {} ({}).\n\nRun them: `udar verify`, one of them: `udar verify hertz`; what each "
      "holds in "
      "detail: [results.md](results.md#a-verification). Orders that `udar converge` finds by itself have a page of "
      "their own: "
      "[convergence](../verification/convergence/README.md).\n\n{}",
      explanation, count_words(count_of(v)), problem_words(v), seconds_words(v.seconds), machine_words(v),
      markdown_contents(v));
  std::string topic;
  for (const VerifiedProblem& problem : v.problems) {
    if (problem.topic != topic) text += fmt::format("\n## {}\n\n", problem.topic);
    topic = problem.topic;
    text += markdown_of(problem);
  }
  while (text.ends_with("\n\n")) text.pop_back();
  return text;
}

std::string verification_html(const Verification& v) {
  const CheckCount count = count_of(v);
  std::string text = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" "
      "content=\"width=device-width, initial-scale=1\">\n<title>Udar: {0} checks "
      "hold</title>\n<style>{1}</style>\n</head>\n"
      "<body>\n<main>\n<header>\n<h1>Verification of Udar</h1>\n<p class=\"{2}\">{0} checks hold, of {3}, in "
      "{4}.</p>\n<p class=\"faint\">{5}</p>\n<p>{6}</p>\n{7}</header>\n",
      count_words(count), style, count.held == count.all ? "good" : "bad", problem_words(v), seconds_words(v.seconds),
      escape_xml(machine_words(v)), escape_xml(explanation), html_contents(v));
  std::string topic;
  for (const VerifiedProblem& problem : v.problems) {
    if (problem.topic != topic) text += fmt::format("<h2>{}</h2>\n", escape_xml(problem.topic));
    topic = problem.topic;
    text += section_of(problem);
  }
  return text + "</main>\n</body>\n</html>\n";
}

void check_verification_folder(const fs::path& folder, bool force) {
  std::error_code error;
  const fs::file_status status = fs::status(folder, error);
  if (!fs::exists(status)) return;
  if (!fs::is_directory(status)) {
    throw UserError(ExitCode::usage, fmt::format("`{}` is no folder", folder.string()), "choose another name");
  }
  if (fs::is_empty(folder, error)) return;
  if (fs::exists(folder / VerificationFiles::data, error)) {
    if (force) return;
    throw UserError(ExitCode::usage, fmt::format("`{}` holds an earlier verification", folder.string()),
                    "replace it with `--force`, or choose another folder with `--output`");
  }
  throw UserError(ExitCode::usage, fmt::format("`{}` holds something else than a verification", folder.string()),
                  "choose another folder with `--output`");
}

void write_verification(const fs::path& folder, const Verification& v) {
  check_verification_folder(folder, true);
  const fs::path pictures = folder / VerificationFiles::pictures;
  std::error_code error;
  fs::create_directories(pictures, error);
  if (error) throw OutputError(fmt::format("cannot make {}: {}", pictures.string(), error.message()));
  for (const fs::directory_entry& entry : fs::directory_iterator(pictures, error)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("verification-") && name.ends_with(".svg")) fs::remove(entry.path(), error);
  }
  write_file(folder / VerificationFiles::data, to_json(v));
  for (const VerifiedProblem& problem : v.problems) {
    std::size_t number = 0;
    for (const VerifiedPart& part : problem.parts) {
      for (const VerificationPlot& plot : verification_plots(part)) {
        write_file(pictures / picture_name(problem.id, ++number), plot.svg);
      }
    }
  }
  write_file(folder / VerificationFiles::markdown, verification_markdown(v));
  write_file(folder / VerificationFiles::page, verification_html(v));
}

}  // namespace udar
