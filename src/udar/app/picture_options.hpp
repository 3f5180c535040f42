#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "udar/app/commands.hpp"
#include "udar/report/frame_picture.hpp"

namespace udar {

/// What `udar picture` and `udar movie` both take, as given.
struct PictureArguments {
  std::string field = "plastic";
  std::string range;
  std::string unit;
  std::string view;
  std::string follow;
  bool mesh = false;  ///< is drawn anyway
  bool no_mesh = false;
  bool smooth = false;
  int width = 1600;
  std::string output;
};

/// The names of all fields, for the help.
std::string fields_text();

void add_picture_options(CLI::App& command, PictureArguments& arguments);

/// The options for the frames of a run. Throws UserError (usage).
FrameView frame_view(const PictureArguments& arguments, const std::filesystem::path& run);

/// The numbers of `words`, with commas between them.
std::vector<std::string> split_list(std::string_view words, char separator);

}  // namespace udar
