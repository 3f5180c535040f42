#include "udar/simulation/checkpoint.hpp"

#include <zlib.h>

#include <cstring>
#include <memory>
#include <string>

#include "fuzz/target.hpp"
#include "udar/base/archive.hpp"
#include "udar/base/error.hpp"
#include "udar/case/build_model.hpp"
#include "udar/case/case_file.hpp"
#include "udar/step/step.hpp"

using namespace udar;

namespace {

/// Two blocks and a wedge-shaped obstacle whose corner digs in: every list of State has entries.
constexpr const char* small_case = R"([run]
end_time = "2 us"
[materials.steel]
law = "tresca"
density = "7850 kg/m^3"
young_modulus = "196 GPa"
poisson_ratio = 0.25
yield_stress = "235 MPa"
[bodies.upper]
material = "steel"
velocity = ["5 m/s", "-80 m/s"]
mesh = { shape = "rectangle", size = ["2 cm", "1 cm"], at = ["0.1 cm", "1 cm"], element_size = "1 cm" }
[bodies.lower]
material = "steel"
mesh = { shape = "rectangle", size = ["2 cm", "1 cm"], at = ["0 cm", "0 cm"], element_size = "1 cm" }
[contact]
friction = 0.3
[obstacles.wedge]
shape = "polygon"
points = [["0.5 cm", "0 cm"], ["0 cm", "-1 cm"], ["1 cm", "-1 cm"]]
velocity = ["0 m/s", "40 m/s"]
friction = 0.3
[[observe.nodes]]
name = "corner"
body = "upper"
at = ["0 m", "2 cm"]
)";

/// The case with its model, built once.
struct Setting {
  Model model = build_model(read_case(small_case, "small"));
  Workspace work{model, 1};
};

Setting& setting() {
  static Setting it;
  return it;
}

/// Sets the checksums right, as whoever makes a hostile file would: else nothing behind them would ever be reached.
void mend_checksums(std::string& bytes) {
  constexpr std::size_t line = 18;
  constexpr std::size_t head = 16;
  for (std::size_t at = line; at + head <= bytes.size();) {
    std::uint32_t name = 0;
    std::uint64_t length = 0;
    std::memcpy(&name, bytes.data() + at, sizeof name);
    std::memcpy(&length, bytes.data() + at + 8, sizeof length);
    const std::size_t left = bytes.size() - at - head;
    if (name > left || length > left - name) return;
    const std::uint64_t lengths[2] = {name, length};
    uLong sum = ::crc32_z(0, reinterpret_cast<const Bytef*>(lengths), sizeof lengths);
    if (name + length > 0) {
      sum = ::crc32_z(sum, reinterpret_cast<const Bytef*>(bytes.data() + at + head), name + length);
    }
    const auto right = static_cast<std::uint32_t>(sum);
    std::memcpy(bytes.data() + at + 4, &right, sizeof right);
    at += head + name + length;
  }
}

/// What `udar resume` does with it, but for the files.
void resume(std::string bytes) {
  Setting& it = setting();
  const Checkpoint checkpoint = read_checkpoint(std::move(bytes), 0);
  State state = state_of(checkpoint, it.model);
  Recorders recorders(it.model, std::nullopt, it.work.pool);
  take_up(checkpoint, recorders);
  for (int k = 0; k < 3 && !finished(it.model, state); ++k) {
    step(it.model, state, it.work);
    recorders.record(state);
  }
  Summary summary;
  recorders.summarise(summary);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string bytes(fuzz::text_of(data, size));
  mend_checksums(bytes);
  try {
    resume(std::move(bytes));
  } catch (const OutputError& error) {
    fuzz::require(error.what()[0] != '\0');
  } catch (const UserError& error) {
    fuzz::require(error.what()[0] != '\0');
  } catch (const NumericalError& error) {
    fuzz::require(error.what()[0] != '\0');
  }
  return 0;
}
