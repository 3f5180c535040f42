#pragma once

#include <optional>

#include "udar/output/contact_recorder.hpp"
#include "udar/output/frame_writer.hpp"
#include "udar/output/history_recorder.hpp"

namespace udar {

/// Everything that is written while a case runs.
class Recorders {
 public:
  Recorders(const Model& model, const std::optional<RunFolder>& folder, Pool& pool)
      : histories_(model, folder ? std::optional(*folder / RunFolder::histories) : std::nullopt), contacts_(model) {
    if (folder) frames_.emplace(model, *folder, pool);
  }

  void begin() { histories_.begin(); }
  void record(const State& state) {
    histories_.record(state);
    contacts_.record(state);
    if (frames_) frames_->record(state);
  }
  /// Hands everything that was recorded to the operating system. The files that changed since it was last called.
  std::vector<std::filesystem::path> settle() {
    histories_.flush();
    std::vector<std::filesystem::path> files = histories_.files();
    if (!frames_) return files;
    for (std::filesystem::path& frame : frames_->settle()) files.push_back(std::move(frame));
    return files;
  }
  /// All that they know between two steps, once settled.
  template <class Archive>
  void carry(Archive& archive) {
    archive(histories_, contacts_);
    if (frames_) archive(*frames_);
  }
  /// Last rows and the last frame; calls `save` with each part that writes.
  template <class Save>
  void close(const State& state, Save&& save) {
    save([&] { histories_.close(state); });
    if (frames_) save([&] { frames_->close(state); });
    frames_.reset();  // what it held is needed no more
  }
  void summarise(Summary& summary) const {
    summary.histories = histories_.summary();
    summary.contacts = contacts_.summary();
  }

 private:
  HistoryRecorder histories_;
  ContactRecorder contacts_;
  std::optional<FrameWriter> frames_;
};

}  // namespace udar
