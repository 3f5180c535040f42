#include "udar/report/drawing.hpp"

#include <fmt/core.h>

#include "udar/base/error.hpp"

namespace udar {

DrawingKind drawing_kind(const std::filesystem::path& path) {
  const std::string ending = path.extension().string();
  if (ending == ".svg") return DrawingKind::svg;
  if (ending == ".pdf") return DrawingKind::pdf;
  if (ending == ".png") return DrawingKind::png;
  throw UserError(ExitCode::usage, fmt::format("`{}` does not end in .svg, .png or .pdf", path.string()),
                  "the ending of --output says what to make");
}

Program converter(DrawingKind kind, int width) {
  Program program{.words = {"rsvg-convert", "--unlimited", kind == DrawingKind::pdf ? "--format=pdf" : "--format=png"},
                  .package = "librsvg2-bin",
                  .cure = "write .svg, which needs no other program"};
  if (width > 0 && kind == DrawingKind::png) program.words.push_back(fmt::format("--width={}", width));
  if (width > 0 && kind == DrawingKind::png) program.words.emplace_back("--keep-aspect-ratio");
  return program;
}

void check_drawing(const std::filesystem::path& path) {
  const DrawingKind kind = drawing_kind(path);
  if (kind != DrawingKind::svg) require(converter(kind, 0));
}

void write_drawing(const std::filesystem::path& path, const std::string& svg, int width) {
  const DrawingKind kind = drawing_kind(path);
  write_file(path, kind == DrawingKind::svg ? svg : run_program(converter(kind, width), svg));
}

}  // namespace udar
