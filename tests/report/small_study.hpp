#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tests/results/scratch.hpp"
#include "tests/simulation/example.hpp"
#include "udar/results/file.hpp"
#include "udar/results/study.hpp"
#include "udar/simulation/simulation.hpp"

/// A study folder made by hand: the falling block on meshes each twice as fine, the coarsest first.
struct SmallStudy {
  Scratch scratch;
  std::filesystem::path folder = scratch / "study";
  udar::Study study;

  explicit SmallStudy(int meshes, double frames_every = 5e-6) {
    std::filesystem::create_directories(folder / udar::StudyFolder::runs);
    udar::write_file(folder / udar::StudyFolder::marker, "");
    study.kind = "converge";
    study.case_name = "block";
    study.meshes = meshes;
    study.mesh_ratio = 2;
    study.steps = 1;
    study.tolerance = 0.02;
    for (int m = 0; m < meshes; ++m) {
      const double size = 0.01 / (1 << m);
      udar::Case input = udar::falling_block(size);
      input.output.fields_every = frames_every;
      input.output.histories_every = 2e-6;
      udar::StudyRun run{.name = "mesh" + std::to_string(m + 1) + "-step1", .mesh = m, .state = "done"};
      udar::Simulation simulation(std::move(input));
      const udar::Summary summary = simulation.run({.folder = folder / udar::StudyFolder::runs / run.name});
      run.verdict = summary.verdict;
      run.elements = static_cast<long long>(summary.elements);
      study.element_sizes.push_back(size);
      study.runs.push_back(run);
    }
    for (const char* name : {"corner.displacement_y", "stop.force_y", "block.position_y", "energy.total"}) {
      study.histories.push_back({.name = name});
    }
    write();
  }
  void write() const { udar::write_file(folder / udar::StudyFolder::study, udar::to_json(study)); }
};
