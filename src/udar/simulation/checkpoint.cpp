#include "udar/simulation/checkpoint.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <type_traits>

#include "udar/base/archive.hpp"
#include "udar/model/check_state.hpp"
#include "udar/simulation/simulation.hpp"
#include "udar/step/stages.hpp"

namespace udar {
namespace {

constexpr const char* run_part = "run";
constexpr const char* recorders_part = "recorders";

std::string state_part(const char* field) { return std::string("state/") + field; }

/// Lists that are as long as there are touches; all else has its length from the model.
template <class Field>
constexpr bool has_free_length =
    std::is_same_v<Field, std::vector<BodyTouch>> || std::is_same_v<Field, std::vector<CornerTouch>> ||
    std::is_same_v<Field, std::vector<PairBook>>;

template <class Field>
std::string_view bytes_of(const Field& field) {
  if constexpr (requires { field.data(); }) {
    static_assert(std::is_trivially_copyable_v<typename Field::value_type>);
    return {reinterpret_cast<const char*>(field.data()), field.size() * sizeof(typename Field::value_type)};
  } else {
    static_assert(std::is_trivially_copyable_v<Field>);
    return {reinterpret_cast<const char*>(&field), sizeof field};
  }
}

template <class Field>
void take(std::string_view bytes, const char* name, Field& field) {
  if constexpr (has_free_length<Field>) {
    using Entry = typename Field::value_type;
    if (bytes.size() % sizeof(Entry) == 0) field.resize(bytes.size() / sizeof(Entry));
  }
  if (bytes_of(field).size() != bytes.size()) {
    throw OutputError(fmt::format("its `{}` does not fit the case", name));
  }
  if (bytes.empty()) return;
  if constexpr (requires { field.data(); }) {
    std::memcpy(field.data(), bytes.data(), bytes.size());
  } else {
    std::memcpy(&field, bytes.data(), bytes.size());
  }
}

/// Does what takes something from a checkpoint, and says whose fault it is where that fails.
template <class Take>
auto use(const Checkpoint& checkpoint, Take&& take_it) {
  try {
    return take_it();
  } catch (const OutputError& error) {
    throw UserError(ExitCode::checkpoint,
                    fmt::format("{} cannot be used: {}", RunFolder::checkpoints[checkpoint.generation], error.what()),
                    "files of the run were changed since: run the case anew, `udar run` with its resolved.toml");
  }
}

/// One of the files, if it is there; what is wrong with it goes to `notes`.
std::optional<Checkpoint> try_checkpoint(const std::filesystem::path& folder, std::size_t generation,
                                         std::vector<std::string>& notes) {
  const std::filesystem::path path = folder / RunFolder::checkpoints[generation];
  std::error_code error;
  if (!std::filesystem::exists(path, error)) return std::nullopt;
  try {
    constexpr std::size_t most_bytes = std::size_t{1} << 40;
    return read_checkpoint(read_file(path, most_bytes), generation);
  } catch (const OutputError& damage) {
    notes.push_back(fmt::format("{} cannot be used: {}", path.string(), damage.what()));
    return std::nullopt;
  }
}

}  // namespace

State state_of(const Checkpoint& checkpoint, const Model& model) {
  return use(checkpoint, [&] {
    State state = rest_state(model);
    for_each_field(state,
                   [&](const char* name, auto& field) { take(checkpoint.file.part(state_part(name)), name, field); });
    check_state(model, state);
    return state;
  });
}

void take_up(const Checkpoint& checkpoint, Recorders& recorders) {
  use(checkpoint, [&] {
    BytesIn archive(checkpoint.file.part(recorders_part));
    archive(recorders);
    archive.finish();
  });
}

Checkpoint read_checkpoint(std::string bytes, std::size_t generation) {
  Checkpoint checkpoint{generation, CheckpointFile(std::move(bytes)), {}};
  BytesIn archive(checkpoint.file.part(run_part));
  archive(checkpoint.run);
  archive.finish();
  if (checkpoint.run.version == version_number()) return checkpoint;
  throw OutputError(fmt::format("another version of Udar wrote it; this one is {}", version_number()));
}

Checkpoint newest_checkpoint(const std::filesystem::path& folder, std::vector<std::string>& notes) {
  std::optional<Checkpoint> newest;
  for (std::size_t k = 0; k < RunFolder::checkpoints.size(); ++k) {
    std::optional<Checkpoint> found = try_checkpoint(folder, k, notes);
    if (found && (!newest || found->run.steps > newest->run.steps)) newest = std::move(found);
  }
  if (newest) return std::move(*newest);
  std::string message = fmt::format("there is no checkpoint in `{}` to go on from", folder.string());
  for (const std::string& note : notes) message += "; " + note;
  throw UserError(ExitCode::checkpoint, message,
                  fmt::format("run it anew: `udar run {} --output {} --force`",
                              (folder / RunFolder::resolved_case).string(), folder.string()));
}

CheckpointKeeper::CheckpointKeeper(RunFolder folder, std::optional<double> every, const Checkpoint* resumed_from)
    : folder_(std::move(folder)), every_(every) {
  if (resumed_from != nullptr) next_ = 1 - resumed_from->generation;
}

bool CheckpointKeeper::is_due() const {
  return every_ && std::chrono::duration<double>(std::chrono::steady_clock::now() - last_).count() >= *every_;
}

void CheckpointKeeper::write(RunSoFar run, const State& state, Recorders& recorders) {
  if (written_for_ == state.clock.step) return;
  sync_files(recorders.settle());
  run.version = version_number();
  run.steps = state.clock.step;
  BytesOut about;
  about(run);
  BytesOut recorded;
  recorded(recorders);
  CheckpointWriter file(folder_ / RunFolder::checkpoints[next_]);
  file.add(run_part, about.bytes());
  file.add(recorders_part, recorded.bytes());
  for_each_field(state, [&](const char* name, const auto& field) { file.add(state_part(name), bytes_of(field)); });
  file.commit();
  next_ = 1 - next_;
  written_for_ = run.steps;
  last_ = std::chrono::steady_clock::now();
}

void CheckpointKeeper::remove() const {
  for (const std::string_view name : RunFolder::checkpoints) {
    std::error_code error;
    std::filesystem::remove(folder_ / name, error);
    if (error) {
      throw OutputError(fmt::format("cannot remove {}: {}", (folder_ / name).string(), error.message()));
    }
  }
}

}  // namespace udar
