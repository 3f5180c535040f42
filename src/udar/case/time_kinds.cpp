#include <fmt/core.h>

#include "udar/case/kinds.hpp"
#include "udar/case/path.hpp"
#include "udar/case/tables.hpp"

namespace udar {
namespace {

Schema<TimeTable> table_schema(const QuantityKind& each) {
  return {.keys = {
              key("times", &TimeTable::times, ListKind{{dimension::time}}, "rising times", required),
              key("values", &TimeTable::values, ListKind{each},
                  "value at each time; before the first and after the last it stays", required),
              key("shape", &TimeTable::shape, WordKind{{"linear", "smooth"}},
                  "straight lines between the points, or curves without a jump in velocity or acceleration"),
          }};
}

bool is_constant(const TimeTable& table) {
  return table.times.size() == 1 && table.values.size() == 1 && table.times[0] == 0 &&
         table.shape == TimeTable::Shape::linear;
}

}  // namespace

std::string TimeTableKind::example() const {
  return fmt::format("{{ times = [\"0 s\", \"1 ms\"], values = [{}, {}] }}", each.write(0), each.example());
}

void TimeTableKind::read(const Value& value, const std::string& path, TimeTable& out, Mistakes& mistakes) const {
  if (value.kind == Value::Kind::table) {
    out = {};
    return read_table(table_schema(each), value, path, out, mistakes);
  }
  double constant = 0;
  each.read(value, path, constant, mistakes);
  out = TimeTable::constant(constant);
}

void TimeTableKind::read(const Value& value, const std::string& path, std::optional<TimeTable>& out,
                         Mistakes& mistakes) const {
  read(value, path, out.emplace(), mistakes);
}

void TimeTableKind::check(const TimeTable& value, const std::string& path, Mistakes& mistakes) const {
  if (is_constant(value)) return each.check(value.values[0], path, mistakes);
  check_table(table_schema(each), value, path, mistakes);
  if (value.times.size() != value.values.size()) {
    mistakes.add_unless_touched({join(path, "values"), "times and values do not match",
                                 fmt::format("{} values for {} times", value.values.size(), value.times.size()),
                                 "give one value for each time"});
  }
  for (std::size_t i = 1; i < value.times.size(); ++i) {
    if (value.times[i] > value.times[i - 1]) continue;
    mistakes.add_unless_touched({join(join(path, "times"), std::to_string(i)), "times do not rise",
                                 "this is not later than the time before it",
                                 "give the times in order, each one once"});
  }
}

void TimeTableKind::check(const std::optional<TimeTable>& value, const std::string& path, Mistakes& mistakes) const {
  if (value) check(*value, path, mistakes);
}

std::string TimeTableKind::write(const TimeTable& value) const {
  return is_constant(value) ? each.write(value.values[0]) : write_inline(table_schema(each), value);
}

void WindowKind::read(const Value& value, const std::string& path, Window& out, Mistakes& mistakes) const {
  const QuantityKind time{dimension::time};
  if (value.kind != Value::Kind::list || value.items.size() != 2) {
    return wrong_kind(value, path, "[from, to]", example(), mistakes);
  }
  time.read(value.items[0], join(path, "0"), out.begin, mistakes);
  const Value& end = value.items[1];
  if (end.kind != Value::Kind::text || end.text != "end") time.read(end, join(path, "1"), out.end, mistakes);
}

void WindowKind::check(const Window& value, const std::string& path, Mistakes& mistakes) const {
  QuantityKind{dimension::time}.check(value.begin, join(path, "0"), mistakes);
  if (value.end > value.begin) return;
  mistakes.add_unless_touched(
      {path, "empty window", "it ends before it begins or with it", "give the earlier time first"});
}

std::string WindowKind::write(const Window& value) const {
  const QuantityKind time{dimension::time};
  const bool open = value.end == Window{}.end;
  return "[" + time.write(value.begin) + ", " + (open ? "\"end\"" : time.write(value.end)) + "]";
}

}  // namespace udar
