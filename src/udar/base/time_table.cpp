#include "udar/base/time_table.hpp"

#include <algorithm>

namespace udar {

double TimeTable::at(double time) const {
  if (times.empty()) return 0;
  if (time <= times.front()) return values.front();
  if (time >= times.back()) return values.back();
  const auto after = std::upper_bound(times.begin(), times.end(), time) - times.begin();
  const auto before = after - 1;
  double s = (time - times[before]) / (times[after] - times[before]);
  if (shape == Shape::smooth) s = s * s * s * (10 - 15 * s + 6 * s * s);
  return values[before] + s * (values[after] - values[before]);
}

}  // namespace udar
