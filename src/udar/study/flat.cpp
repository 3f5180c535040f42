#include "udar/study/flat.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <map>
#include <nlohmann/json.hpp>
#include <string_view>

#include "udar/base/error.hpp"
#include "udar/base/text.hpp"
#include "udar/case/document.hpp"
#include "udar/study/run_difference.hpp"

namespace udar {
namespace {

using Json = nlohmann::ordered_json;

/// What another machine, another number of threads or another day changes.
constexpr std::array<std::string_view, 8> of_the_machine{
    "version", "started",      "machine",          "threads",
    "resumed", "wall_seconds", "stepping_seconds", "element_steps_per_second"};

std::string joined(const std::string& path, const std::string& name) { return path.empty() ? name : path + "." + name; }

bool is_vector(const Json& json) {
  return json.is_array() && json.size() == 2 &&
         std::all_of(json.begin(), json.end(), [](const Json& v) { return v.is_number() || v.is_null(); });
}

/// How an item of a list is called.
std::string item_name(const Json& item, std::size_t number) {
  if (item.is_object() && item.contains("name") && item.at("name").is_string()) {
    return item.at("name").get<std::string>();
  }
  return std::to_string(number);
}

void flatten(const Json& json, const std::string& path, FlatValues& out) {
  if (json.is_object()) {
    for (const auto& [name, value] : json.items()) {
      const bool skipped =
          path.empty() && std::find(of_the_machine.begin(), of_the_machine.end(), name) != of_the_machine.end();
      if (!skipped) flatten(value, joined(path, name), out);
    }
  } else if (is_vector(json)) {
    out.emplace_back(path + ".x", json[0].dump());
    out.emplace_back(path + ".y", json[1].dump());
  } else if (json.is_array()) {
    for (std::size_t k = 0; k < json.size(); ++k) flatten(json[k], joined(path, item_name(json[k], k)), out);
  } else {
    out.emplace_back(path, json.dump(-1, ' ', false, Json::error_handler_t::replace));
  }
}

std::string text_of(const Value& value) {
  switch (value.kind) {
    case Value::Kind::boolean:
      return value.number != 0 ? "true" : "false";
    case Value::Kind::number:
      return shortest(value.number);
    case Value::Kind::text:
      return value.text;
    case Value::Kind::list: {
      std::string text;
      for (const Value& item : value.items) text += (text.empty() ? "" : ", ") + text_of(item);
      return "[" + text + "]";
    }
    default:
      return "";
  }
}

bool holds_tables(const Value& list) {
  return std::any_of(list.items.begin(), list.items.end(), [](const Value& v) { return v.kind == Value::Kind::table; });
}

void flatten(const Value& value, const std::string& path, FlatValues& out) {
  if (value.kind == Value::Kind::table) {
    for (const Entry& entry : value.entries) flatten(entry.value, joined(path, entry.key), out);
  } else if (value.kind == Value::Kind::list && holds_tables(value)) {
    for (std::size_t k = 0; k < value.items.size(); ++k) {
      const Entry* name = value.items[k].find("name");
      const bool named = name != nullptr && name->value.kind == Value::Kind::text;
      flatten(value.items[k], joined(path, named ? name->value.text : std::to_string(k)), out);
    }
  } else {
    out.emplace_back(path, text_of(value));
  }
}

/// Each name of a with the values of both, then what only b has.
template <class Visit>
void for_each_name(const FlatValues& a, const FlatValues& b, Visit visit) {
  std::map<std::string_view, const std::string*> values_b;
  for (const auto& [name, value] : b) values_b.emplace(name, &value);
  std::map<std::string_view, bool> seen;
  for (const auto& [name, value] : a) {
    const auto at = values_b.find(name);
    visit(name, &value, at == values_b.end() ? nullptr : at->second);
    seen.emplace(name, true);
  }
  for (const auto& [name, value] : b) {
    if (!seen.contains(name)) visit(name, static_cast<const std::string*>(nullptr), &value);
  }
}

/// The number of a JSON text; NaN for anything else.
double number_in(const std::string* text) {
  double value = std::numeric_limits<double>::quiet_NaN();
  if (text == nullptr) return value;
  const auto [end, error] = std::from_chars(text->data(), text->data() + text->size(), value);
  const bool whole = error == std::errc() && end == text->data() + text->size();
  return whole ? value : std::numeric_limits<double>::quiet_NaN();
}

bool is_number(const std::string* text) { return text != nullptr && number_in(text) == number_in(text); }

}  // namespace

FlatValues flat_summary(const std::string& text) {
  FlatValues out;
  try {
    flatten(Json::parse(text), "", out);
  } catch (const Json::exception& error) {
    throw OutputError(fmt::format("cannot read summary.json: {}", error.what()));
  }
  return out;
}

FlatValues flat_case(const std::string& text) {
  FlatValues out;
  if (const auto document = parse_document(text, "resolved.toml")) flatten(document->root, "", out);
  return out;
}

std::string first_difference(const FlatValues& a, const FlatValues& b) {
  std::string first;
  for_each_name(a, b, [&](const std::string& name, const std::string* one, const std::string* two) {
    const bool same = one != nullptr && two != nullptr && *one == *two;
    if (first.empty() && !same) first = name;
  });
  return first;
}

std::vector<NumberDifference> compare_summaries(const std::string& a, const std::string& b) {
  std::vector<NumberDifference> found;
  for_each_name(flat_summary(a), flat_summary(b),
                [&](const std::string& name, const std::string* one, const std::string* two) {
                  if (is_number(one) || is_number(two)) found.push_back({name, number_in(one), number_in(two)});
                });
  return found;
}

std::vector<KeyDifference> compare_cases(const std::string& a, const std::string& b) {
  std::vector<KeyDifference> found;
  const FlatValues one = flat_case(a);
  const FlatValues two = flat_case(b);
  if (one.empty() || two.empty()) return found;
  for_each_name(one, two, [&](const std::string& key, const std::string* in_a, const std::string* in_b) {
    if (in_a != nullptr && in_b != nullptr && *in_a == *in_b) return;
    found.push_back({key, in_a == nullptr ? "" : *in_a, in_b == nullptr ? "" : *in_b});
  });
  return found;
}

}  // namespace udar
