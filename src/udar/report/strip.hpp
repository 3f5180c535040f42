#pragma once

#include <string>
#include <vector>

#include "udar/results/picture.hpp"

namespace udar {

/// Small pictures side by side that are read alike: one scale of lengths, one of colours. Each has a view of the same
/// size, and its own words as its title.
struct PictureStrip {
  std::string title;
  std::string subtitle;
  std::vector<Picture> pictures;  ///< at least one
  int columns = 2;
};

/// The strip as an SVG file, 1000 px wide, with one legend below all.
std::string to_svg(const PictureStrip& strip);

}  // namespace udar
