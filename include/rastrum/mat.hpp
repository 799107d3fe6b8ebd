// SPDX-License-Identifier: BSD-3-Clause
// 4 × 4 matrices, row-major, that multiply column vectors. Composition is done in float64 and
// rounded to float32 once, so that the vertex transform (float32) starts from the nearest matrix.
#pragma once

#include <cmath>
#include <optional>
#include <utility>

#include <rastrum/vec.hpp>

namespace RASTRUM_API rastrum {

template <class T>
struct Mat4Of {
  T m[4][4] = {};  ///< m[row][column]

  static constexpr Mat4Of identity() {
    Mat4Of r;
    for (int i = 0; i < 4; ++i) r.m[i][i] = 1;
    return r;
  }
  template <class U>
  constexpr explicit operator Mat4Of<U>() const {
    Mat4Of<U> r;
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j) r.m[i][j] = static_cast<U>(m[i][j]);
    return r;
  }
};

using Mat4 = Mat4Of<float>;
using Mat4d = Mat4Of<double>;

template <class T>
constexpr Mat4Of<T> operator*(const Mat4Of<T>& a, const Mat4Of<T>& b) {
  Mat4Of<T> r;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j)
      for (int k = 0; k < 4; ++k) r.m[i][j] += a.m[i][k] * b.m[k][j];
  return r;
}

// Matrices from the 16 numbers of other programs. Vectors are columns in both; the order differs.

/// From numbers row after row, as in C arrays and NumPy. `T`: float or double.
template <class T>
constexpr Mat4d matrix_from_rows(const T* m) {
  Mat4d r;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) r.m[i][j] = static_cast<double>(m[4 * i + j]);
  return r;
}
/// From numbers column after column, as in OpenGL, glTF, GLM and Eigen.
template <class T>
constexpr Mat4d matrix_from_columns(const T* m) {
  Mat4d r;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) r.m[i][j] = static_cast<double>(m[4 * j + i]);
  return r;
}

/// The inverse, by Gauss and Jordan's elimination with the largest pivot of a column first; none if
/// a pivot is 0 or not finite.
[[nodiscard]] inline std::optional<Mat4d> inverse(Mat4d a) {
  Mat4d r = Mat4d::identity();
  for (int k = 0; k < 4; ++k) {
    int pivot = k;
    for (int i = k + 1; i < 4; ++i)
      if (std::abs(a.m[i][k]) > std::abs(a.m[pivot][k])) pivot = i;
    std::swap(a.m[k], a.m[pivot]);
    std::swap(r.m[k], r.m[pivot]);
    const double p = a.m[k][k];
    if (p == 0 || !std::isfinite(p)) return std::nullopt;
    for (int j = 0; j < 4; ++j) {
      a.m[k][j] /= p;
      r.m[k][j] /= p;
    }
    for (int i = 0; i < 4; ++i) {
      if (i == k) continue;
      const double f = a.m[i][k];
      for (int j = 0; j < 4; ++j) {
        a.m[i][j] -= f * a.m[k][j];
        r.m[i][j] -= f * r.m[k][j];
      }
    }
  }
  return r;
}

/// M · (p, 1) in float32, each row left to right: ((m0·x + m1·y) + m2·z) + m3. This order is part
/// of the picture rules (docs/conventions.md); every backend keeps it.
RASTRUM_HD inline Vec4 transform_point(const Mat4& a, Vec3 p) {
  const auto& m = a.m;
  return {((m[0][0] * p.x + m[0][1] * p.y) + m[0][2] * p.z) + m[0][3],
          ((m[1][0] * p.x + m[1][1] * p.y) + m[1][2] * p.z) + m[1][3],
          ((m[2][0] * p.x + m[2][1] * p.y) + m[2][2] * p.z) + m[2][3],
          ((m[3][0] * p.x + m[3][1] * p.y) + m[3][2] * p.z) + m[3][3]};
}

}  // namespace rastrum
