#pragma once

#include <map>
#include <string>
#include <vector>

#include "udar/model/model.hpp"
#include "udar/model/state.hpp"
#include "udar/results/summary.hpp"

namespace udar {

/// Follows the touches of every obstacle and every pair of bodies: when, how long, how hard, and what came of it.
class ContactRecorder {
 public:
  explicit ContactRecorder(const Model& model);
  /// To be called at t_0 and after every step.
  void record(const State& state);
  /// Episodes with gaps shorter than 2 % of the whole merged.
  [[nodiscard]] std::map<std::string, ContactSummary> summary() const;

 private:
  /// An interval with force.
  struct Touch {
    double begin = 0;  ///< s
    double end = 0;    ///< s; of the last step so far while it lasts
    bool over = false;
    Vec2 impulse_before{};  ///< N s, of the obstacle until then
    Vec2 impulse_after{};   ///< N s
    Vec2 normal_before{};   ///< N s, without friction
    Vec2 normal_after{};
    double peak_force = 0;              ///< N
    std::vector<Vec2> momentum_before;  ///< kg m/s, body by body
    std::vector<Vec2> momentum_after;
    std::vector<bool> touched;  ///< bodies that touched
  };
  /// Impulse so far at a time, thinned when there are many.
  struct Curve {
    std::vector<double> time;   ///< s
    std::vector<Vec2> impulse;  ///< N s
    std::uint64_t every = 1;    ///< steps between two points
  };
  /// An obstacle with all bodies, or two bodies.
  struct Partners {
    std::string name;
    std::size_t book = 0;  ///< in State::obstacles or State::pairs
    bool two_bodies = false;
    std::size_t first = 0;  ///< bodies
    std::size_t second = 0;
    std::vector<Touch> touches;
    Curve curve;
  };
  void touch_step(Partners& partners, const ContactBook& book, const State& state);
  [[nodiscard]] EpisodeSummary episode(const Partners& partners, const Touch& first, const Touch& last, double peak,
                                       const std::vector<bool>& touched) const;
  [[nodiscard]] ContactSummary summary_of(const Partners& partners) const;

  const Model& model_;
  std::vector<Partners> partners_;
  std::vector<Vec2> last_momentum_;  ///< kg m/s, body by body, before the step
};

}  // namespace udar
