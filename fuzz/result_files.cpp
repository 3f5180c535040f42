#include <fmt/core.h>
#include <sys/mman.h>
#include <unistd.h>

#include <array>
#include <string>

#include "fuzz/target.hpp"
#include "udar/base/error.hpp"
#include "udar/results/histories.hpp"
#include "udar/results/pvd.hpp"
#include "udar/results/study.hpp"
#include "udar/results/summary.hpp"
#include "udar/results/summary_numbers.hpp"
#include "udar/results/vtu.hpp"
#include "udar/study/history_source.hpp"

using namespace udar;

namespace {

/// A file in memory, for readers that want a path.
class MemoryFile {
 public:
  explicit MemoryFile(std::string_view text) : number_(::memfd_create("fuzz", 0)) {
    fuzz::require(number_ >= 0);
    fuzz::require(::write(number_, text.data(), text.size()) == static_cast<ssize_t>(text.size()));
  }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  ~MemoryFile() { ::close(number_); }
  [[nodiscard]] std::string path() const { return fmt::format("/proc/self/fd/{}", number_); }

 private:
  int number_;
};

/// What was read is written so that the same is read back.
void check_frame(std::string_view text) {
  const std::string written = to_vtu(parse_vtu(text));
  fuzz::require(to_vtu(parse_vtu(written)) == written);
}

/// Frames are also read in parts, from a file.
void check_part_of_frame(std::string_view text) {
  const MemoryFile file(text);
  const std::vector<std::string> names = vtu_fields(file.path());
  VtuPart part{.fields = {}, .places = false};
  if (!names.empty()) part.fields = {names.front()};
  const VtuGrid some = read_vtu(file.path(), part);
  fuzz::require(some.points.empty() && some.ends.empty());
}

void check_index(std::string_view text) {
  const std::string written = to_pvd(parse_pvd(text));
  fuzz::require(to_pvd(parse_pvd(written)) == written);
}

void check_history(std::string_view text) {
  const History history = parse_csv(text, "fuzz.csv");
  fuzz::require(!history.columns.empty() && history.columns.size() == history.values.size());
  for (const auto& column : history.values) fuzz::require(column.size() == history.values.front().size());
}

void check_summary(std::string_view text) {
  const Summary summary = summary_from_json(text);
  const std::string written = to_json(summary);
  fuzz::require(to_json(summary_from_json(written)) == written);
  numbers_of(summary);
  first_touch(summary);
}

void check_study(std::string_view text) {
  const std::string written = to_json(study_from_json(text));
  fuzz::require(to_json(study_from_json(written)) == written);
}

void check_table(std::string_view text) {
  const MemoryFile file(text);
  const MeasuredTable table = read_table(file.path(), {.maps = {}, .most_values = std::size_t{1} << 20});
  for (const auto& history : table.values) {
    for (const auto& column : history) fuzz::require(column.size() == table.times.size());
  }
}

}  // namespace

/// The first byte chooses the reader, by its letter or by its number; the others are the file.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  constexpr std::string_view letters = "vwpcjst";
  constexpr std::array readers{check_frame,   check_part_of_frame, check_index, check_history,
                               check_summary, check_study,         check_table};
  const std::size_t letter = letters.find(static_cast<char>(data[0]));
  try {
    readers[letter == std::string_view::npos ? data[0] % readers.size() : letter](fuzz::text_of(data + 1, size - 1));
  } catch (const OutputError& error) {
    fuzz::require(error.what()[0] != '\0');
  } catch (const UserError& error) {
    fuzz::require(error.what()[0] != '\0');
  }
  return 0;
}
