#pragma once

#include <filesystem>
#include <string>

#include "udar/report/program.hpp"

namespace udar {

/// What a drawing is kept as.
enum class DrawingKind { svg, pdf, png };

/// By the ending of the file's name. Throws UserError (usage) where it is another one.
DrawingKind drawing_kind(const std::filesystem::path& path);

/// What turns an SVG drawing into this kind, `width` px wide (png; 0: as wide as the drawing). Not for svg.
Program converter(DrawingKind kind, int width);

/// Refuses a file that could not be written, before any work: another ending, or a program that is missing. Throws
/// UserError, OutputError.
void check_drawing(const std::filesystem::path& path);

/// Writes an SVG drawing as the file's ending says, all or nothing; `width` as above. PNG and PDF are made by
/// rsvg-convert. Throws UserError, OutputError.
void write_drawing(const std::filesystem::path& path, const std::string& svg, int width);

}  // namespace udar
