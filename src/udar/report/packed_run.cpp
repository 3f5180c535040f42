#include "udar/report/packed_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "udar/base/error.hpp"
#include "udar/base/text.hpp"
#include "udar/report/encode.hpp"
#include "udar/results/histories.hpp"
#include "udar/results/run_frames.hpp"

namespace udar {
namespace {

namespace fs = std::filesystem;

/// The mesh of the first frame that can be read; those that cannot are taken out of the list.
ReportMesh first_mesh(RunFiles& run) {
  while (!run.frames.empty()) {
    try {
      return read_mesh(run.frames.front());
    } catch (const OutputError& error) {
      run.troubles.emplace_back(error.what());
      run.frames.erase(run.frames.begin());
    }
  }
  return {};
}

/// What of the run is asked for, as far as its frames have it.
class Wish {
 public:
  Wish(const ReportMesh& mesh, const ReportOptions& options, std::size_t frames) {
    for (const Quantity& q : all_quantities) {
      const bool there = std::find(mesh.fields.begin(), mesh.fields.end(), q.field) != mesh.fields.end();
      const bool known = std::find(there_.begin(), there_.end(), q.word) != there_.end();
      if (!q.word.empty() && !known && (there || mesh.fields.empty())) there_.emplace_back(q.word);
    }
    there_.emplace_back(contact_force_word);
    for (const std::string& name : options.fields) check(name);
    const bool all = options.fields.empty();
    for (const std::string& word : there_) {
      if (word == contact_force_word) continue;
      const bool follows = (word == "max_shear" || word == "pressure") && stresses_tell(all ? there_ : options.fields);
      const bool asked = std::find(options.fields.begin(), options.fields.end(), word) != options.fields.end();
      if (!follows && (all || asked)) choice.words.push_back(word);
    }
    choice.forces =
        all || std::find(options.fields.begin(), options.fields.end(), contact_force_word) != options.fields.end();
    if (options.frames > 0) choice.every = every_for(frames, options.frames);
  }

  Choice choice;

 private:
  /// Of the three principal stresses the page makes the others.
  static bool stresses_tell(const std::vector<std::string>& words) {
    return std::all_of(principal.begin(), principal.end(),
                       [&](std::string_view p) { return std::find(words.begin(), words.end(), p) != words.end(); });
  }
  static constexpr std::array<std::string_view, 3> principal{"principal_1", "principal_2", "principal_3"};

  void check(const std::string& name) const {
    if (std::find(there_.begin(), there_.end(), name) != there_.end()) return;
    const std::string near = nearest_word(name, there_);
    throw UserError(ExitCode::usage, fmt::format("there is no field `{}` in the frames", name),
                    near.empty() ? "choose of " + one_of(there_) : fmt::format("did you mean `{}`?", near));
  }

  std::vector<std::string> there_;
};

Json described_bodies(const RunFiles& run, const ReportMesh& mesh) {
  const std::vector<BodySummary> told = run.summary ? run.summary->bodies : std::vector<BodySummary>{};
  Json out = Json::array();
  for (std::size_t b = 0; b < std::max(mesh.bodies.size(), mesh.bodies.empty() ? told.size() : 0); ++b) {
    const MeshBody body = b < mesh.bodies.size() ? mesh.bodies[b] : MeshBody{};
    const bool named = b < told.size() && (mesh.bodies.empty() || told.size() == mesh.bodies.size());
    out.push_back({{"name", named ? told[b].name : fmt::format("body {}", b + 1)},
                   {"rigid", named && told[b].rigid},
                   {"node_begin", body.node_begin},
                   {"node_end", body.node_end},
                   {"element_begin", body.element_begin},
                   {"element_end", body.element_end}});
  }
  return out;
}

/// Where observers sit, as places in the arrays of the report.
Json described_observers(const RunFiles& run, const ReportMesh& mesh) {
  Json out = Json::object();
  if (!run.summary || run.summary->bodies.size() != mesh.bodies.size()) return out;
  const std::vector<BodySummary>& bodies = run.summary->bodies;
  for (const auto& [name, observed] : run.summary->observed) {
    const std::string& body_name = observed.body;
    const auto at = std::find_if(bodies.begin(), bodies.end(), [&](const auto& b) { return b.name == body_name; });
    if (at == bodies.end()) continue;
    const MeshBody& body = mesh.bodies[static_cast<std::size_t>(at - bodies.begin())];
    const bool node = observed.on == "node";
    const auto& numbers = node ? mesh.node_numbers : mesh.element_numbers;
    const std::size_t begin = node ? body.node_begin : body.element_begin;
    const std::size_t end = node ? body.node_end : body.element_end;
    for (std::size_t i = begin; i < end; ++i) {
      if (numbers[i] != observed.number) continue;
      out[name] = {{"on", node ? "nodes" : "elements"}, {"index", i}};
      break;
    }
  }
  return out;
}

/// Adds histories until they take `most_bytes`; gives how many that leaves out.
Json packed_histories(RunFiles& run, std::size_t most_bytes, Blocks& blocks, std::size_t& left_out) {
  Json out = Json::array();
  std::size_t taken = 0;
  left_out = 0;
  for (const fs::path& file : run.histories) {
    if (left_out > 0) {
      ++left_out;
      continue;
    }
    try {
      const History history = read_csv(file);
      Json columns = Json::array();
      std::vector<float> values;
      for (std::size_t c = 0; c < history.columns.size(); ++c) {
        columns.push_back({{"name", history.columns[c].name}, {"unit", history.columns[c].unit}});
        for (const double v : history.values[c]) values.push_back(static_cast<float>(v));
      }
      const std::size_t rows = history.values.front().size();
      PackedArray array = pack_floats(values, rows);
      array.rows = history.columns.size();  // also where no row is written yet
      const std::size_t bytes = block_bytes(array.text.size()) + columns.dump().size() + 200;
      if (taken + bytes > most_bytes) {
        ++left_out;
        continue;
      }
      taken += bytes;
      out.push_back(
          {{"name", file.stem().string()}, {"columns", std::move(columns)}, {"values", blocks.add(std::move(array))}});
    } catch (const OutputError& error) {
      run.troubles.emplace_back(error.what());
    }
  }
  return out;
}

/// Outlines of the obstacles in the frames of a choice, each set of them once.
Json described_outlines(RunFiles& run, const std::vector<std::size_t>& frames) {
  Json sets = Json::array();
  Json of_frame = Json::array();
  std::vector<std::vector<std::vector<Vec2>>> known;
  for (const std::size_t f : frames) {
    std::vector<std::vector<Vec2>> outlines;
    try {
      outlines = read_outlines(run.frames[f]);
    } catch (const OutputError& error) {
      run.troubles.emplace_back(error.what());
      run.frames[f].obstacles.clear();
    }
    const auto at = std::find(known.begin(), known.end(), outlines);
    of_frame.push_back(at - known.begin());
    if (at != known.end()) continue;
    Json set = Json::array();
    for (const auto& outline : outlines) {
      Json points = Json::array();
      for (const Vec2& p : outline) points.push_back({p.x, p.y});
      set.push_back(std::move(points));
    }
    sets.push_back(std::move(set));
    known.push_back(std::move(outlines));
  }
  return {{"sets", std::move(sets)}, {"of_frame", std::move(of_frame)}};
}

/// A run on its way into a page.
class RunPacker {
 public:
  RunPacker(RunFiles run, const ReportOptions& options, const RunRoom& room, Blocks& blocks)
      : run_(std::move(run)), options_(options), room_(room), blocks_(blocks), first_block_(blocks.count()) {}

  PackedRun pack() {
    const std::size_t before = blocks_.bytes();
    mesh_ = first_mesh(run_);
    describe_run();
    fixed_blocks_ = blocks_.count();
    for (;;) {
      try {
        Ladder ladder(Wish(mesh_, options_, run_.frames.size()).choice, run_.frames.size(), options_.fields);
        return fit(ladder, before);
      } catch (const BrokenFrame& broken) {
        blocks_.cut(fixed_blocks_);
        run_.troubles.emplace_back(broken.what());
        run_.frames.erase(run_.frames.begin() + static_cast<std::ptrdiff_t>(broken.frame));
      }
    }
  }

 private:
  /// Everything that is the same however many frames there are.
  void describe_run() {
    description_["case_name"] = case_name_of(run_);
    description_["version"] = run_.version;
    description_["summary"] = run_.summary ? Json::parse(run_.summary_text) : Json();
    description_["case_text"] = run_.case_text;
    description_["resolved_text"] = run_.resolved_text;
    description_["log"] = run_.log;
    description_["nodes"] = mesh_.nodes;
    description_["elements"] = mesh_.elements;
    description_["corners"] = blocks_.add(pack_numbers(mesh_.corners, mesh_.elements));
    description_["node_numbers"] = blocks_.add(pack_numbers(mesh_.node_numbers, mesh_.nodes));
    description_["element_numbers"] = blocks_.add(pack_numbers(mesh_.element_numbers, mesh_.elements));
    description_["bodies"] = described_bodies(run_, mesh_);
    description_["observed"] = described_observers(run_, mesh_);
    std::size_t left_out = 0;
    description_["histories"] = packed_histories(run_, room_.histories, blocks_, left_out);
    if (left_out > 0) {
      histories_left_out_ =
          fmt::format("{} of {} histories are left out: they are in histories/", left_out, run_.histories.size());
    }
  }

  /// Goes down the ladder until the run has room. `before`: bytes of the blocks of others.
  PackedRun fit(Ladder& ladder, std::size_t before) {
    const FrameEncoder encoder(run_, mesh_, options_.interrupted);
    const std::size_t fixed = safe_json(description_).size() + blocks_.bytes() - before;
    std::optional<Costs> costs;
    double pessimism = 1;  // how many times the frames took what was expected
    const auto expected = [&] { return pessimism * estimate(*costs, ladder.choice(), run_.frames.size()); };
    const auto step_down = [&](bool at_least_once) {
      if (!costs) costs = encoder.measure(ladder.choice());
      while (at_least_once || static_cast<double>(fixed) + expected() > static_cast<double>(room_.all)) {
        at_least_once = false;
        if (!ladder.step()) return false;
      }
      return true;
    };
    // Numbers take less than a byte each, most often; where that may not do, a sample tells.
    const std::size_t numbers = encoder.numbers_in_frame(ladder.choice()) * run_.frames.size();
    bool possible = fixed + numbers <= room_.all || step_down(false);
    while (possible) {
      if (const auto frames = encoder.encode(ladder.choice(), blocks_, before + room_.all)) {
        Json description = described(*frames, ladder);
        const std::size_t bytes = safe_json(description).size() + blocks_.bytes() - before;
        if (bytes <= room_.all) return {std::move(description), bytes, frames_of(ladder).size(), sentences(ladder)};
        if (costs && expected() > 0) pessimism *= std::max(1.0, static_cast<double>(bytes - fixed) / expected());
      }
      blocks_.cut(fixed_blocks_);
      possible = step_down(true);
    }
    blocks_.cut(first_block_);
    throw RunTooLarge{fixed};
  }

  [[nodiscard]] std::vector<std::size_t> frames_of(const Ladder& ladder) const {
    return chosen_frames(run_.frames.size(), ladder.choice().every);
  }

  /// The whole description.
  Json described(const Json& frames, const Ladder& ladder) {
    Json all = description_;
    const std::vector<std::size_t> chosen = frames_of(ladder);
    Json times = Json::array();
    for (const std::size_t f : chosen) times.push_back(run_.frames[f].time);
    all["times"] = std::move(times);
    all.update(frames);
    all["outlines"] = described_outlines(run_, chosen);
    all["left_out"] = sentences(ladder);
    return all;
  }

  [[nodiscard]] std::vector<std::string> sentences(const Ladder& ladder) const {
    std::vector<std::string> out = ladder.sentences();
    if (!options_.fields.empty()) out.emplace_back("of the fields only those asked for are here");
    if (!histories_left_out_.empty()) out.push_back(histories_left_out_);
    out.insert(out.end(), run_.troubles.begin(), run_.troubles.end());
    return out;
  }

  RunFiles run_;
  const ReportOptions& options_;
  RunRoom room_;
  Blocks& blocks_;
  std::size_t first_block_;
  ReportMesh mesh_;
  std::size_t fixed_blocks_ = 0;
  Json description_{{"format", 1}};
  std::string histories_left_out_;
};

}  // namespace

PackedRun pack_run(RunFiles run, const ReportOptions& options, const RunRoom& room, Blocks& blocks) {
  return RunPacker(std::move(run), options, room, blocks).pack();
}

}  // namespace udar
