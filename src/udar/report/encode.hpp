#pragma once

#include <array>
#include <functional>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>

#include "udar/report/choose.hpp"
#include "udar/report/frames.hpp"
#include "udar/report/page.hpp"

namespace udar {

/// A frame that cannot be read: the report goes on without it.
struct BrokenFrame : std::runtime_error {
  BrokenFrame(std::size_t number, const std::string& why) : std::runtime_error(why), frame(number) {}
  std::size_t frame;  ///< in RunFiles::frames
};

/// Whoever waits has asked to stop.
struct ReportInterrupted {};

/// What a quantity costs in a frame, from a sample of the frames.
struct Cost {
  std::map<int, double> bytes;  ///< of a frame in the file, by bits
  double halved = 0;            ///< of the sample where every other frame is left out
  double growth = 1;            ///< how many times a frame then takes as much: those that are left differ more
};
/// By name of quantity and, for forces, contact_force_word.
using Costs = std::map<std::string, Cost, std::less<>>;

/// Turns the frames of a run into blocks of a report. Of the frames it holds a chunk of one quantity, or of a few where
/// they are small: about as much memory as the run itself took.
class FrameEncoder {
 public:
  FrameEncoder(const RunFiles& run, const ReportMesh& mesh, std::function<bool()> interrupted)
      : run_(run), mesh_(mesh), interrupted_(std::move(interrupted)) {}

  /// Adds the frames of a choice; gives `quantities`, `forces`, `centre_x` and `centre_y` of the report, or nothing as
  /// soon as the blocks are larger than `most_bytes`. Throws BrokenFrame, ReportInterrupted.
  [[nodiscard]] std::optional<Json> encode(const Choice& choice, Blocks& blocks, std::size_t most_bytes) const;
  /// What the quantities of a choice cost, with all bits that may be chosen. Throws as `encode`.
  [[nodiscard]] Costs measure(const Choice& choice) const;
  /// Numbers of all quantities of a choice in a frame.
  [[nodiscard]] std::size_t numbers_in_frame(const Choice& choice) const;

 private:
  [[nodiscard]] static std::vector<Quantity> quantities_of(const Choice& choice);
  [[nodiscard]] std::size_t count_of(const Quantity& q) const { return q.on_nodes ? mesh_.nodes : mesh_.elements; }
  [[nodiscard]] std::size_t frames_in_chunk() const;
  /// What is read at once, one part after the other; places and forces with the first.
  [[nodiscard]] std::vector<Wanted> parts_of(const Choice& choice) const;
  [[nodiscard]] Chunk read(const std::vector<std::size_t>& frames, std::size_t begin, std::size_t end,
                           const Wanted& wanted) const;

  const RunFiles& run_;
  const ReportMesh& mesh_;
  std::function<bool()> interrupted_;
};

/// Bytes of the frames of a choice in the file.
double estimate(const Costs& costs, const Choice& choice, std::size_t frames);

}  // namespace udar
