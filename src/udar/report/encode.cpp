#include "udar/report/encode.hpp"

#include <algorithm>
#include <cmath>

#include "udar/base/error.hpp"

namespace udar {
namespace {

constexpr std::array field_bits{12, 10, 8};
constexpr int force_bits = 16;

/// A table of a quantity; of numbers that are only yes or no every one is exact.
PackedArray packed(const Quantity& quantity, std::span<const float> values, std::size_t columns, int bits) {
  if (quantity.bits != 1) return pack_rounded(values, columns, quantity.bits > 0 ? quantity.bits : bits);
  std::vector<std::uint32_t> flags(values.size());
  std::transform(values.begin(), values.end(), flags.begin(), [](float v) { return v == 1 ? 1U : 0U; });
  return pack_numbers(flags, columns);
}

/// The rows 0, 2, 4, ... of a table.
std::vector<float> every_other_row(const std::vector<float>& values, std::size_t columns) {
  std::vector<float> out;
  for (std::size_t row = 0; row * columns < values.size(); row += 2) {
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(row * columns);
    out.insert(out.end(), at, at + static_cast<std::ptrdiff_t>(columns));
  }
  return out;
}

Json packed_forces(const NodeForces& forces, std::size_t first, Blocks& blocks) {
  Json out{{"first", first}, {"counts", forces.counts}};
  if (forces.nodes.empty()) return out;
  out["nodes"] = blocks.add(pack_numbers(forces.nodes, forces.nodes.size()));
  out["x"] = blocks.add(pack_rounded(forces.x, forces.x.size(), force_bits));
  out["y"] = blocks.add(pack_rounded(forces.y, forces.y.size(), force_bits));
  return out;
}

/// N.
double largest_of(const NodeForces& forces) {
  double largest = 0;
  for (std::size_t k = 0; k < forces.x.size(); ++k) {
    const double force = length(Vec2{forces.x[k], forces.y[k]});
    if (std::isfinite(force)) largest = std::max(largest, force);
  }
  return largest;
}

}  // namespace

std::vector<Quantity> FrameEncoder::quantities_of(const Choice& choice) {
  std::vector<Quantity> out;
  for (const Quantity& q : all_quantities) {
    if (q.word.empty() || choice.has(q.word)) out.push_back(q);
  }
  return out;
}

std::size_t FrameEncoder::numbers_in_frame(const Choice& choice) const {
  std::size_t sum = 0;
  for (const Quantity& q : quantities_of(choice)) sum += count_of(q);
  return sum;
}

std::size_t FrameEncoder::frames_in_chunk() const {
  constexpr std::size_t usual = 25;
  constexpr std::size_t most_numbers = std::size_t{1} << 25;  // of a quantity; 128 MB
  return std::clamp<std::size_t>(most_numbers / std::max<std::size_t>(mesh_.elements, 1), 5, usual);
}

std::vector<Wanted> FrameEncoder::parts_of(const Choice& choice) const {
  constexpr std::size_t most_numbers = std::size_t{1} << 22;  // 16 MB
  std::vector<Wanted> parts{{.quantities = {}, .places = true, .forces = choice.forces}};
  std::size_t numbers = 0;
  for (const Quantity& q : quantities_of(choice)) {
    const std::size_t more = count_of(q) * frames_in_chunk();
    if (numbers + more > most_numbers && !q.field.empty()) {
      parts.push_back({.quantities = {}, .places = false, .forces = false});
      numbers = 0;
    }
    parts.back().quantities.push_back(q);
    numbers += more;
  }
  return parts;
}

Chunk FrameEncoder::read(const std::vector<std::size_t>& frames, std::size_t begin, std::size_t end,
                         const Wanted& wanted) const {
  Chunk chunk;
  for (std::size_t f = begin; f < end; ++f) {
    if (interrupted_ && interrupted_()) throw ReportInterrupted{};
    try {
      add_frame(run_.frames[frames[f]], mesh_, wanted, chunk);
    } catch (const OutputError& error) {
      throw BrokenFrame(frames[f], error.what());
    }
  }
  return chunk;
}

std::optional<Json> FrameEncoder::encode(const Choice& choice, Blocks& blocks, std::size_t most_bytes) const {
  const std::vector<Wanted> parts = parts_of(choice);
  const std::vector<std::size_t> frames = chosen_frames(run_.frames.size(), choice.every);
  const std::size_t at_once = frames_in_chunk();
  Json quantities = Json::array();
  for (const Quantity& q : quantities_of(choice)) {
    quantities.push_back(
        {{"name", q.name}, {"unit", q.unit}, {"on", q.on_nodes ? "nodes" : "elements"}, {"chunks", Json::array()}});
  }
  Json force_chunks = Json::array();
  double largest_force = 0;  // N
  std::vector<double> centre_x;
  std::vector<double> centre_y;
  for (std::size_t first = 0; first < frames.size(); first += at_once) {
    std::size_t number = 0;  // in `quantities`
    for (const Wanted& part : parts) {
      const Chunk chunk = read(frames, first, std::min(first + at_once, frames.size()), part);
      for (std::size_t q = 0; q < part.quantities.size(); ++q) {
        const Quantity& quantity = part.quantities[q];
        Json packed_chunk{{"first", first}};
        packed_chunk.update(blocks.add(packed(quantity, chunk.values[q], count_of(quantity), choice.bits)));
        quantities[number++]["chunks"].push_back(std::move(packed_chunk));
        if (blocks.bytes() > most_bytes) return std::nullopt;
      }
      if (part.forces) {
        force_chunks.push_back(packed_forces(chunk.forces, first, blocks));
        largest_force = std::max(largest_force, largest_of(chunk.forces));
      }
      centre_x.insert(centre_x.end(), chunk.centre_x.begin(), chunk.centre_x.end());
      centre_y.insert(centre_y.end(), chunk.centre_y.begin(), chunk.centre_y.end());
    }
  }
  constexpr int centre_bits = 32;
  const std::size_t bodies = mesh_.bodies.size();
  Json out{{"quantities", std::move(quantities)}};
  if (choice.forces) out["forces"] = {{"unit", "N"}, {"largest", largest_force}, {"chunks", std::move(force_chunks)}};
  out["centre_x"] = blocks.add(pack_rounded(centre_x, bodies, centre_bits));
  out["centre_y"] = blocks.add(pack_rounded(centre_y, bodies, centre_bits));
  if (blocks.bytes() > most_bytes) return std::nullopt;
  return out;
}

namespace {

/// Adds what a table of a quantity takes, whole and with every other row.
void add_cost(const Quantity& quantity, const std::vector<float>& values, std::size_t columns, Cost& cost) {
  const auto bytes = [&](std::span<const float> table, int bits) {
    return static_cast<double>(block_bytes(packed(quantity, table, columns, bits).text.size()));
  };
  const bool one_way = quantity.bits > 0;
  for (const int bits : field_bits) {
    if (!one_way || bits == field_bits[0]) cost.bytes[bits] += bytes(values, bits);
  }
  if (one_way) {
    for (const int bits : field_bits) cost.bytes[bits] = cost.bytes[field_bits[0]];
  }
  cost.halved += bytes(every_other_row(values, columns), field_bits.back());
}

}  // namespace

Costs FrameEncoder::measure(const Choice& choice) const {
  constexpr std::size_t samples = 3;
  const std::vector<std::size_t> frames = chosen_frames(run_.frames.size(), choice.every);
  const std::size_t at_once = frames_in_chunk();
  const std::size_t chunks = (frames.size() + at_once - 1) / at_once;
  Costs costs;
  Cost& forces = costs[std::string(contact_force_word)];
  double rows = 0;
  double rows_halved = 0;
  for (std::size_t s = 0; s < std::min(samples, chunks); ++s) {
    // In the middle of each third: an impact begins with nothing and may end so.
    const std::size_t first = chunks <= samples ? s * at_once : (2 * s + 1) * chunks / (2 * samples) * at_once;
    const std::size_t end = std::min(first + at_once, frames.size());
    const std::size_t every_other = (end - first + 1) / 2;
    rows += static_cast<double>(end - first);
    rows_halved += static_cast<double>(every_other);
    for (const Wanted& part : parts_of(choice)) {
      const Chunk chunk = read(frames, first, end, part);
      for (std::size_t q = 0; q < part.quantities.size(); ++q) {
        const Quantity& quantity = part.quantities[q];
        add_cost(quantity, chunk.values[q], count_of(quantity), costs[std::string(quantity.name)]);
      }
      if (!part.forces) continue;
      Blocks blocks;
      const std::size_t description = packed_forces(chunk.forces, 0, blocks).dump().size();
      for (const int bits : field_bits) forces.bytes[bits] += static_cast<double>(blocks.bytes() + description);
    }
  }
  for (auto& [name, cost] : costs) {
    for (auto& [bits, bytes] : cost.bytes) bytes /= rows;
    if (cost.halved > 0) cost.growth = std::max(1.0, cost.halved / rows_halved / cost.bytes[field_bits.back()]);
  }
  return costs;
}

double estimate(const Costs& costs, const Choice& choice, std::size_t frames) {
  const auto count = static_cast<double>(chosen_frames(frames, choice.every).size());
  const double halvings = choice.every > 1 ? std::log2(static_cast<double>(choice.every)) : 0;
  double sum = 0;
  const auto add = [&](std::string_view name) {
    const auto at = costs.find(name);
    if (at != costs.end() && !at->second.bytes.empty())
      sum += at->second.bytes.at(choice.bits) * std::pow(at->second.growth, halvings) * count;
  };
  for (const Quantity& q : all_quantities) {
    if (q.word.empty() || choice.has(q.word)) add(q.name);
  }
  if (choice.forces) add(contact_force_word);
  return sum;
}

}  // namespace udar
