#pragma once

#include <string>
#include <vector>

#include "tests/results/scratch.hpp"
#include "udar/results/histories.hpp"
#include "udar/results/pvd.hpp"
#include "udar/results/run_folder.hpp"
#include "udar/results/vtu.hpp"

/// A run folder with two bodies of two triangles each in every frame; values are told by time, so that a test knows
/// them. The second body flies to the right with 100 m/s.
struct SmallRun {
  Scratch scratch;
  std::filesystem::path folder = scratch / "small";

  explicit SmallRun(const std::vector<double>& times) {
    const udar::RunFolder run = udar::create_run_folder(folder, false);
    udar::PvdIndex index(run / udar::RunFolder::fields_index);
    int number = 0;
    for (const double time : times) {
      const std::string bodies = udar::RunFolder::frame_name("bodies", number);
      const std::string obstacles = udar::RunFolder::frame_name("obstacles", number++);
      udar::write_vtu(run / bodies, grid(time));
      udar::VtuGrid stop;
      stop.add_polygon(std::vector<udar::Vec2>{{-1, -0.5}, {2, -0.5}, {2, 0}, {-1, 0}});
      udar::write_vtu(run / obstacles, stop);
      index.add({{time, 0, bodies}, {time, 1, obstacles}});
    }
    index.write();
  }

  static std::vector<double> stresses(double time) { return {1e6, -2e6, 3e6, 1e9 * time}; }

  static udar::VtuGrid grid(double time) {
    const double right = 2 + 100 * time;
    const std::vector<udar::Vec2> points{{0, 0},     {1, 0},         {1, 1},         {0, 1},
                                         {right, 0}, {right + 1, 0}, {right + 1, 1}, {right, 1}};
    const std::vector<std::array<std::int32_t, 3>> triangles{{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}};
    udar::VtuGrid grid = udar::triangle_grid(time, points, triangles);
    const std::vector<double> stress = stresses(time);
    grid.cell_fields.push_back(udar::scalar_field("principal_1", "Pa", stress));
    grid.cell_fields.push_back(udar::scalar_field("plastic_strain", "", std::vector<double>{0, 0.1, 0.2, 0}));
    grid.cell_fields.push_back(udar::flag_field("flows_now", std::vector<std::uint8_t>{0, 1, 0, 0}));
    grid.cell_fields.push_back(udar::number_field("body", std::vector<std::int32_t>{0, 0, 1, 1}));
    std::vector<udar::Vec2> velocities(8);
    for (std::size_t i = 4; i < 8; ++i) velocities[i] = {100, static_cast<double>(i)};
    grid.point_fields.push_back(udar::vector_field("velocity", "m/s", velocities));
    grid.point_fields.push_back(udar::vector_field("contact_force", "N", velocities));
    return grid;
  }

  /// Adds a history: values[c] are the rows of column c, the time first.
  void add_history(const std::string& name, const std::vector<udar::Column>& columns,
                   const std::vector<std::vector<double>>& rows) const {
    udar::HistoryWriter writer(folder / udar::RunFolder::histories / (name + ".csv"), columns);
    for (const auto& row : rows) writer.write_row(row);
    writer.close();
  }
};
