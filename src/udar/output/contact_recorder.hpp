#pragma once

#include <map>
#include <string>
#include <vector>

#include "udar/model/model.hpp"
#include "udar/model/state.hpp"
#include "udar/results/summary.hpp"

namespace udar {

/// Follows the touches of every obstacle and of every two bodies that meet: when, how long, how hard, and what came of
/// it. What it keeps and does grows with what touches, not with the number of pairs there might be.
class ContactRecorder {
 public:
  explicit ContactRecorder(const Model& model);
  /// To be called at t_0 and after every step.
  void record(const State& state);
  /// Episodes with gaps shorter than 2 % of the whole merged.
  [[nodiscard]] std::map<std::string, ContactSummary> summary() const;
  /// All that it knows of the steps so far. Throws OutputError where what is read does not fit the model.
  template <class Archive>
  void carry(Archive& archive);

 private:
  /// What a body carries along.
  struct Motion {
    Vec2 momentum{};  ///< kg m/s
    double spin = 0;  ///< kg m2/s, about its centre of mass

    template <class Archive>
    void carry(Archive& archive) {
      archive(momentum, spin);
    }
  };
  struct BodyNow {
    Vec2 centre{};  ///< m, of mass
    Motion motion;

    template <class Archive>
    void carry(Archive& archive) {
      archive(centre, motion);
    }
  };
  /// A body in a touch.
  struct Toucher {
    Index body = 0;
    bool touches = false;  ///< in the step looked at last
    Motion before;         ///< when it first touched
    Motion after;          ///< when it last did
    double pressed = 0;    ///< N s, sum of the sizes of the normal impulses on it
    Vec2 arm{};            ///< N s m, sum of the same times the way from its centre of mass

    template <class Archive>
    void carry(Archive& archive) {
      archive(body, touches, before, after, pressed, arm);
    }
  };
  /// An interval with force.
  struct Touch {
    double begin = 0;  ///< s
    double end = 0;    ///< s; of the last step so far while it lasts
    bool over = false;
    Vec2 impulse_before{};  ///< N s, of the obstacle until then
    Vec2 impulse_after{};   ///< N s
    Vec2 normal_before{};   ///< N s, without friction
    Vec2 normal_after{};
    double peak_force = 0;          ///< N
    std::vector<Toucher> touchers;  ///< in the order of bodies

    template <class Archive>
    void carry(Archive& archive) {
      archive(begin, end, over, impulse_before, impulse_after, normal_before, normal_after, peak_force, touchers);
    }
  };
  /// Impulse so far at a time, thinned when there are many.
  struct Curve {
    std::vector<double> time;   ///< s
    std::vector<Vec2> impulse;  ///< N s
    std::uint64_t every = 1;    ///< steps between two points

    template <class Archive>
    void carry(Archive& archive) {
      archive(time, impulse, every);
    }
  };
  /// An obstacle with all bodies, or two bodies, or a body with itself.
  struct Partners {
    const Obstacle* obstacle = nullptr;  ///< nullptr: bodies
    Index first = 0;
    Index second = 0;
    std::vector<Touch> touches;
    int merged_gaps = 0;  ///< that are no more among the touches
    Curve curve;

    template <class Archive>
    void carry(Archive& archive) {
      archive(first, second, touches, merged_gaps, curve);
    }
  };
  void check(const Partners& partners) const;
  void look_at_bodies(const State& state);
  void follow(Partners& partners, const ContactBook& book, const State& state);
  void begin_touch(Partners& partners, double time);
  void press(Touch& touch, Index body, Vec2 place, double impulse);
  void press_obstacle(std::size_t obstacle, const State& state);
  void press_corners(const State& state);
  void press_bodies(const State& state);
  Toucher& toucher(Touch& touch, Index body) const;
  void draw(Curve& curve, const Touch& touch, std::uint64_t step) const;
  static void join(Touch& touch, const Touch& next);
  [[nodiscard]] Vec2 velocity_at_contact(const Toucher& toucher, const Motion& motion) const;
  void add_rotation(const Partners& partners, const Touch& touch, EpisodeSummary& e) const;
  [[nodiscard]] EpisodeSummary episode(const Partners& partners, const Touch& touch) const;
  [[nodiscard]] ContactSummary summary_of(const Partners& partners) const;

  const Model& model_;
  std::vector<Partners> obstacles_;
  std::vector<Partners> pairs_;  ///< that have met, in the order of State::pairs
  std::vector<double> inertia_;  ///< kg m2, of each body at rest about its centre of mass
  std::vector<BodyNow> now_;     ///< body by body
  std::vector<BodyNow> last_;    ///< before the step
};

}  // namespace udar
