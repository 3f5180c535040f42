#include "udar/contact/shapes.hpp"

namespace udar {

PreparedShape prepare(const Shape& shape) {
  return std::visit([](const auto& s) { return PreparedShape{s.prepared()}; }, shape);
}

Gap gap(const PreparedShape& shape, Vec2 point) {
  return std::visit([&](const auto& s) { return s.gap(point); }, shape);
}

std::vector<Polyline> outline(const PreparedShape& shape, const Box& view) {
  return std::visit([&](const auto& s) { return s.outline(view); }, shape);
}

double inner_radius(const PreparedShape& shape) {
  return std::visit([](const auto& s) { return s.inner_radius(); }, shape);
}

Box bounds(const PreparedShape& shape) {
  return std::visit([](const auto& s) { return s.bounds(); }, shape);
}

}  // namespace udar
