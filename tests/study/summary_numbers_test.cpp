#include "udar/results/summary_numbers.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <set>

#include "tests/results/scratch.hpp"
#include "udar/case/case_file.hpp"
#include "udar/results/histories.hpp"
#include "udar/results/run_folder.hpp"
#include "udar/simulation/simulation.hpp"

using namespace udar;

namespace {

Summary run_shipped(const char* name, const std::vector<std::string>& changes, const std::filesystem::path& folder) {
  const auto file = std::filesystem::path(UDAR_SOURCE_DIR) / "cases" / name / (std::string(name) + ".toml");
  std::vector<std::string> all{"output.fields_every=never"};
  all.insert(all.end(), changes.begin(), changes.end());
  Simulation simulation(load_case(file, all));
  return simulation.run({.folder = folder});
}

}  // namespace

TEST_CASE("units of numbers are those that the histories name") {
  const Scratch scratch;
  // Between them: nodes, elements, bodies, rigid ones, obstacles, pairs, supports, the books.
  run_shipped("short-beam", {"bodies.beam.mesh.element_size=2 cm", "run.end_time=5 us"}, scratch / "beam");
  run_shipped("hammer", {"run.end_time=1 us"}, scratch / "hammer");
  run_shipped("wedge", {"run.end_time=1 us"}, scratch / "wedge");
  std::set<std::string> units;
  for (const char* run : {"beam", "hammer", "wedge"}) {
    for (const auto& file : std::filesystem::directory_iterator(scratch / run / RunFolder::histories)) {
      const std::string history = file.path().stem().string();
      const History rows = read_csv(file.path());
      for (std::size_t c = 1; c < rows.columns.size(); ++c) {
        CAPTURE(history);
        CAPTURE(rows.columns[c].name);
        CHECK(unit_of_quantity(history, rows.columns[c].name) == rows.columns[c].unit);
        units.insert(rows.columns[c].unit);
      }
    }
  }
  CHECK(units.size() >= 9);
}

TEST_CASE("scales of a run follow from its masses, energy, size and duration") {
  Summary s;
  s.masses = {{"a", 1.5}, {"b", 0.5}};
  s.ledger.start = 100;
  s.ledger.total = 99;
  s.end_time = 0.01;
  s.histories["a"]["position_y"].max_abs = 0.25;
  const RunScales scales(s);
  CHECK(scales.of("J") == 100);
  CHECK(scales.of("N s") == doctest::Approx(20));
  CHECK(scales.of("kg m/s") == doctest::Approx(20));
  CHECK(scales.of("m/s") == doctest::Approx(10));
  CHECK(scales.of("kg m^2/s") == doctest::Approx(5));
  CHECK(scales.of("m/s^2") == doctest::Approx(1000));
  CHECK(scales.of("N") == doctest::Approx(2000));
  CHECK(scales.of("Pa") == 0);
  CHECK(RunScales(Summary{}).of("N") == 0);
}

TEST_CASE("an open contact has no duration") {
  Summary s;
  ContactSummary& c = s.contacts["stop"];
  c.first_touch = 0.001;
  c.duration = c.duration_99 = 0.5;
  c.episodes.push_back({.first_touch = 0.001, .duration = 0.5});
  const auto has = [&](const std::string& name) {
    for (const SummaryNumber& n : numbers_of(s)) {
      if (n.name == name) return true;
    }
    return false;
  };
  CHECK(has("contacts.stop.first_touch"));
  CHECK_FALSE(has("contacts.stop.duration"));
  CHECK_FALSE(has("contacts.stop.duration_99"));
  CHECK_FALSE(has("contacts.stop.episodes.0.duration"));
  c.last_separation = c.episodes[0].separation = 0.501;
  CHECK(has("contacts.stop.duration_99"));
  CHECK(has("contacts.stop.episodes.0.duration"));
}
