#include <fmt/core.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "udar/base/text.hpp"
#include "udar/study/run_difference.hpp"

namespace udar {
namespace {

using Json = nlohmann::ordered_json;

std::string cell(double value) { return std::isnan(value) ? "" : shortest(value); }

/// A name between quotes where a table would be torn by it.
std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

Json json_of_column(const ColumnDifference& c) {
  const HistoryDifference& d = c.difference;
  return {{"name", c.name},
          {"unit", c.unit},
          {"same_bits", c.same_bits},
          {"negligible", c.negligible},
          {"l2", d.l2},
          {"size", d.size},
          {"relative_l2", relative_l2(d)},
          {"max_difference", d.max_abs},
          {"time_of_max", d.time_of_max},
          {"largest", d.largest},
          {"relative_max", relative_max(d)},
          {"parted", d.parted},
          {"from", d.from},
          {"span", d.span},
          {"left_out", d.left_out}};
}

}  // namespace

std::string to_csv(const RunDifference& difference) {
  std::string out =
      "name,unit,same_bits,negligible,l2,size,relative_l2,max_difference,time_of_max [s],largest,relative_max,"
      "parted [s],from [s],span [s],left_out\n";
  for (const ColumnDifference& c : difference.columns) {
    const HistoryDifference& d = c.difference;
    out += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", quoted(c.name), quoted(c.unit),
                       c.same_bits ? 1 : 0, c.negligible ? 1 : 0, cell(d.l2), cell(d.size), cell(relative_l2(d)),
                       cell(d.max_abs), cell(d.time_of_max), cell(d.largest), cell(relative_max(d)), cell(d.parted),
                       cell(d.from), cell(d.span), d.left_out);
  }
  return out;
}

std::string to_json(const RunDifference& difference) {
  Json out{{"schema", 1}, {"same_bits", nullptr}, {"first", nullptr}, {"moved", difference.moved}};
  if (difference.bits) {
    const BitDifference& bits = *difference.bits;
    out["same_bits"] = bits.same;
    if (!bits.same) out["first"] = Json{{"where", bits.where}, {"how", bits.how}, {"time", bits.time}};
  }
  out["columns"] = Json::array();
  for (const ColumnDifference& c : difference.columns) out["columns"].push_back(json_of_column(c));
  out["only_in_a"] = difference.only_in_a;
  out["only_in_b"] = difference.only_in_b;
  out["case"] = Json::array();
  for (const KeyDifference& k : difference.keys) out["case"].push_back({{"key", k.key}, {"a", k.a}, {"b", k.b}});
  out["summary"] = Json::array();
  for (const NumberDifference& n : difference.numbers) {
    out["summary"].push_back({{"name", n.name}, {"a", n.a}, {"b", n.b}, {"difference", n.b - n.a}});
  }
  out["notes"] = difference.notes;
  return out.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

}  // namespace udar
