#pragma once

#include <optional>
#include <string>
#include <utility>

#include "udar/base/human_unit.hpp"
#include "udar/report/field.hpp"
#include "udar/results/picture.hpp"

namespace udar {

/// What the user asked to see of a frame.
struct FrameView {
  const FieldKind* field = &find_field("plastic_strain");
  std::optional<std::pair<double, double>> range;  ///< SI, where the colours begin and end; none: of nearly all values
  std::optional<HumanUnit> unit;                   ///< of the colour bar; none: one that suits the values
  std::optional<Extent> view;                      ///< m; none: everything that is in the frames
  std::optional<int> follow;                       ///< number of a body that stays in the middle
  bool mesh = true;
  bool smooth = false;  ///< colours run evenly between the means at nodes
};

/// Looks at all frames that are to be shown alike, so that they get one range of colours and one size of view.
class FrameSurvey {
 public:
  explicit FrameSurvey(FrameView view) : view_(std::move(view)) {}
  /// Throws UserError (usage) where the body to follow is missing, OutputError where the field is.
  void add(const Frame& frame);
  /// The picture of a frame that was added. It has a subtitle with the time, and no title.
  [[nodiscard]] Picture picture_of(const Frame& frame) const;

 private:
  void add_values(const Frame& frame);
  [[nodiscard]] Extent view_for(const Frame& frame) const;
  void paint(const Frame& frame, Picture& picture) const;

  FrameView view_;
  double low_ = 0;            ///< SI; all but the smallest hundredth of the values of each frame are above
  double high_ = 0;           ///< SI; all but the largest hundredth are below
  double longest_force_ = 0;  ///< N
  Extent shown_;              ///< m, of all frames
  Vec2 largest_{};            ///< m, sides of the box of the body that is followed
};

/// The range of colours for values that lie from `low` to `high`: from or to 0 where they are nearly all of one sign,
/// else as far down as up; ends are round numbers.
std::pair<double, double> round_range(double low, double high);

}  // namespace udar
