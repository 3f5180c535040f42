#pragma once

#include <cmath>

namespace udar {

/// A vector or point of the plane. Units are those of what it holds (m, m/s, N, ...).
struct Vec2 {
  double x = 0;
  double y = 0;

  friend constexpr bool operator==(const Vec2&, const Vec2&) = default;
  constexpr Vec2& operator+=(Vec2 b) { return x += b.x, y += b.y, *this; }
  constexpr Vec2& operator-=(Vec2 b) { return x -= b.x, y -= b.y, *this; }
  constexpr Vec2& operator*=(double s) { return x *= s, y *= s, *this; }
};

constexpr Vec2 operator+(Vec2 a, Vec2 b) { return {a.x + b.x, a.y + b.y}; }
constexpr Vec2 operator-(Vec2 a, Vec2 b) { return {a.x - b.x, a.y - b.y}; }
constexpr Vec2 operator-(Vec2 a) { return {-a.x, -a.y}; }
constexpr Vec2 operator*(double s, Vec2 a) { return {s * a.x, s * a.y}; }
constexpr Vec2 operator*(Vec2 a, double s) { return {s * a.x, s * a.y}; }

constexpr double dot(Vec2 a, Vec2 b) { return a.x * b.x + a.y * b.y; }
/// Out-of-plane component of a x b.
constexpr double cross(Vec2 a, Vec2 b) { return a.x * b.y - a.y * b.x; }
/// `a` turned by +90 degrees.
constexpr Vec2 perpendicular(Vec2 a) { return {-a.y, a.x}; }
inline double length(Vec2 a) { return std::sqrt(dot(a, a)); }
/// Twice the signed area of the triangle a, b, c: positive when they run counter-clockwise.
constexpr double twice_area(Vec2 a, Vec2 b, Vec2 c) { return cross(b - a, c - a); }

/// A turn of the plane, kept as its cosine and sine so that applying it needs no libm.
struct Turn {
  double cos = 1;
  double sin = 0;
};

constexpr Vec2 operator*(Turn q, Vec2 a) { return {q.cos * a.x - q.sin * a.y, q.sin * a.x + q.cos * a.y}; }

/// The turn by `angle` (rad) from additions and multiplications only: libm picks its sin and cos by processor, and the
/// last bit then differs from machine to machine. Error below 4e-16 for |angle| < 1e5. Of what is no number: no number.
Turn turn_by(double angle);

}  // namespace udar
