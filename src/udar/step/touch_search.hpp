#pragma once

#include "udar/step/workspace.hpp"

namespace udar {

/// Dashpot of a touch, N s/m.
double dashpot_of(const Model& model, const BodyTouch& touch);
/// Coulomb's coefficient of a touch; 0 where nothing could take up its couple.
double friction_of(const Model& model, const BodyTouch& touch);

/// Finds out whether points touch a boundary in this step, and presses the springs of those that do. Only `sums` and
/// what it is told to add to are written, so that several of them can be at work side by side.
class TouchSearch {
 public:
  TouchSearch(const Model& model, const State& state, const BodyContact& contact, ContactSums& sums)
      : model_(model), state_(state), contact_(contact), sums_(sums), h_(state.clock.last_step) {}

  /// Adds the touch of a point with the boundary of one body, if there is one. `near` are its segments near the point,
  /// `before` the touch of the last step or null.
  void look(std::uint32_t point, std::uint32_t body, const std::uint32_t* near, const std::uint32_t* near_end,
            const BodyTouch* before, std::vector<BodyTouch>& touches);
  /// The same for a corner of an obstacle.
  void look(std::uint32_t point, std::uint32_t body, const std::uint32_t* near, const std::uint32_t* near_end,
            const CornerTouch* before, std::vector<CornerTouch>& touches);

 private:
  [[nodiscard]] auto place() const {
    return [places = contact_.places.data()](std::uint32_t point) { return places[point]; };
  }
  template <class Touch>
  bool find(std::uint32_t point, std::uint32_t body, const std::uint32_t* near, const std::uint32_t* near_end,
            const Touch* before, Touch& touch, Foot& foot) const;
  [[nodiscard]] Vec2 normal_of(std::uint32_t point) const;
  [[nodiscard]] double size_at(std::uint32_t point, std::uint32_t segment) const;
  [[nodiscard]] double deepest_first_touch(std::uint32_t point, std::uint32_t segment) const;
  [[nodiscard]] Foot nearest_foot(std::uint32_t point, const std::uint32_t* near, const std::uint32_t* near_end) const;
  [[nodiscard]] Vec2 moved(std::uint32_t point) const;
  [[nodiscard]] Vec2 slip_of(BodyTouch& touch, const Foot& foot) const;
  [[nodiscard]] Gap deeper_end(const CornerTouch& touch, std::uint32_t& point) const;
  bool press(BodyTouch& touch, const Foot& foot, double stiffness);
  void enter(const BodyTouch& touch, double normal_energy);

  const Model& model_;
  const State& state_;
  const BodyContact& contact_;
  ContactSums& sums_;
  double h_;
};

}  // namespace udar
