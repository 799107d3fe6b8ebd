// SPDX-License-Identifier: BSD-3-Clause
// Small vectors: aggregates of float without padding, so that a caller's `float[3]` arrays can be
// viewed as `Vec3` without a copy.
#pragma once

#include <cmath>
#include <concepts>

#include <rastrum/config.hpp>

namespace RASTRUM_API rastrum {

struct Vec2 {
  float x = 0, y = 0;
};
struct Vec3 {
  float x = 0, y = 0, z = 0;
};
struct Vec4 {
  float x = 0, y = 0, z = 0, w = 0;
};
static_assert(sizeof(Vec3) == 12 && sizeof(Vec4) == 16);

RASTRUM_HD constexpr Vec2 operator+(Vec2 a, Vec2 b) {
  return {a.x + b.x, a.y + b.y};
}
RASTRUM_HD constexpr Vec2 operator-(Vec2 a, Vec2 b) {
  return {a.x - b.x, a.y - b.y};
}
RASTRUM_HD constexpr Vec2 operator-(Vec2 a) {
  return {-a.x, -a.y};
}
RASTRUM_HD constexpr Vec2 operator*(Vec2 a, float s) {
  return {a.x * s, a.y * s};
}
RASTRUM_HD constexpr Vec2 operator*(Vec2 a, Vec2 b) {
  return {a.x * b.x, a.y * b.y};
}
RASTRUM_HD constexpr Vec2 operator/(Vec2 a, float s) {
  return {a.x / s, a.y / s};
}
RASTRUM_HD constexpr bool operator==(Vec2 a, Vec2 b) {
  return a.x == b.x && a.y == b.y;
}

RASTRUM_HD constexpr Vec3 operator+(Vec3 a, Vec3 b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
RASTRUM_HD constexpr Vec3 operator-(Vec3 a, Vec3 b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
RASTRUM_HD constexpr Vec3 operator-(Vec3 a) {
  return {-a.x, -a.y, -a.z};
}
RASTRUM_HD constexpr Vec3 operator*(Vec3 a, float s) {
  return {a.x * s, a.y * s, a.z * s};
}
RASTRUM_HD constexpr Vec3 operator*(Vec3 a, Vec3 b) {
  return {a.x * b.x, a.y * b.y, a.z * b.z};
}
RASTRUM_HD constexpr Vec3 operator/(Vec3 a, float s) {
  return {a.x / s, a.y / s, a.z / s};
}
RASTRUM_HD constexpr bool operator==(Vec3 a, Vec3 b) {
  return a.x == b.x && a.y == b.y && a.z == b.z;
}

RASTRUM_HD constexpr Vec4 operator+(Vec4 a, Vec4 b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z, a.w + b.w};
}
RASTRUM_HD constexpr Vec4 operator-(Vec4 a, Vec4 b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z, a.w - b.w};
}
RASTRUM_HD constexpr Vec4 operator-(Vec4 a) {
  return {-a.x, -a.y, -a.z, -a.w};
}
RASTRUM_HD constexpr Vec4 operator*(Vec4 a, float s) {
  return {a.x * s, a.y * s, a.z * s, a.w * s};
}
RASTRUM_HD constexpr Vec4 operator*(Vec4 a, Vec4 b) {
  return {a.x * b.x, a.y * b.y, a.z * b.z, a.w * b.w};
}
RASTRUM_HD constexpr Vec4 operator/(Vec4 a, float s) {
  return {a.x / s, a.y / s, a.z / s, a.w / s};
}
RASTRUM_HD constexpr bool operator==(Vec4 a, Vec4 b) {
  return a.x == b.x && a.y == b.y && a.z == b.z && a.w == b.w;
}

// Operators that follow from those above, for Vec2, Vec3 and Vec4.
template <class V>
concept Vector = std::same_as<V, Vec2> || std::same_as<V, Vec3> || std::same_as<V, Vec4>;

template <Vector V>
RASTRUM_HD constexpr V operator*(float s, V a) {
  return a * s;
}
template <Vector V>
RASTRUM_HD constexpr V& operator+=(V& a, V b) {
  return a = a + b;
}
template <Vector V>
RASTRUM_HD constexpr V& operator-=(V& a, V b) {
  return a = a - b;
}
template <Vector V>
RASTRUM_HD constexpr V& operator*=(V& a, V b) {
  return a = a * b;
}
template <Vector V>
RASTRUM_HD constexpr V& operator*=(V& a, float s) {
  return a = a * s;
}
template <Vector V>
RASTRUM_HD constexpr V& operator/=(V& a, float s) {
  return a = a / s;
}

RASTRUM_HD constexpr float dot(Vec3 a, Vec3 b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
RASTRUM_HD constexpr Vec3 cross(Vec3 a, Vec3 b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
RASTRUM_HD inline float length(Vec3 a) {
  return std::sqrt(dot(a, a));
}
/// The unit vector along `a`; `a` itself where its length is 0.
RASTRUM_HD inline Vec3 normalize(Vec3 a) {
  const float l = length(a);
  return l > 0 ? a * (1 / l) : a;
}
RASTRUM_HD inline bool is_finite(Vec3 a) {
  return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}

/// A point or direction in float64, for where a camera stands, and for what is computed before it
/// is rounded to float32 once. A Vec3 converts to it implicitly; the way back rounds and is
/// explicit. Its functions are friends, found for it alone, so calls with a Vec3 stay unambiguous.
struct Vec3d {
  double x = 0, y = 0, z = 0;

  constexpr Vec3d() = default;
  RASTRUM_HD constexpr Vec3d(double x_, double y_, double z_) : x(x_), y(y_), z(z_) {}
  RASTRUM_HD constexpr Vec3d(Vec3 a) : x(a.x), y(a.y), z(a.z) {}
  RASTRUM_HD constexpr explicit operator Vec3() const {
    return {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
  }

  RASTRUM_HD friend constexpr Vec3d operator+(Vec3d a, Vec3d b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
  }
  RASTRUM_HD friend constexpr Vec3d operator-(Vec3d a, Vec3d b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
  }
  RASTRUM_HD friend constexpr Vec3d operator-(Vec3d a) { return {-a.x, -a.y, -a.z}; }
  RASTRUM_HD friend constexpr Vec3d operator*(Vec3d a, double s) {
    return {a.x * s, a.y * s, a.z * s};
  }
  RASTRUM_HD friend constexpr bool operator==(Vec3d a, Vec3d b) {
    return a.x == b.x && a.y == b.y && a.z == b.z;
  }
  RASTRUM_HD friend constexpr double dot(Vec3d a, Vec3d b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
  }
  RASTRUM_HD friend constexpr Vec3d cross(Vec3d a, Vec3d b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
  }
  RASTRUM_HD friend double length(Vec3d a) { return std::sqrt(dot(a, a)); }
  /// The unit vector along `a`; `a` itself where its length is 0.
  RASTRUM_HD friend Vec3d normalize(Vec3d a) {
    const double l = length(a);
    return l > 0 ? a * (1 / l) : a;
  }
  RASTRUM_HD friend bool is_finite(Vec3d a) {
    return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
  }
};

}  // namespace rastrum
