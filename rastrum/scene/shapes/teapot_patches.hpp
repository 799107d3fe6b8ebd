// SPDX-License-Identifier: BSD-3-Clause
// The control points of the teapot that Martin Newell designed at the University of Utah in 1975,
// in the proportions that became known (Blinn's, 1/1.3 of the height). Public domain; told in F.
// Crow, "The Origins of the Teapot", IEEE CG&A 7(1), 1987.
//
// The usual listing of 306 points and 32 patches is redundant: rim, body, lid and bottom are
// profiles turned in quarters, handle and spout mirrored halves. Here is the rest, in Newell's
// coordinates: z up, the spout toward +x, base at z = 0. (The listing has 0.78 for one coordinate
// of the rim whose seven mirror images are 0.784.)
#pragma once

#include <array>
#include <cstddef>

#include <rastrum/vec.hpp>

namespace rastrum::shapes {

/// Rows run from the rim down, the knob down, the centre of the bottom outward, or the body
/// outward; column × row direction points outward.
struct BezierPatch {
  Vec3d points[4][4];  ///< [row][column]
};

namespace teapot_data {

/// A row of control points of a surface of revolution. `bulge`: the offset of the two inner ones,
/// 0.56 · radius but for the knob.
struct Ring {
  double radius, bulge, z;
};
/// A row of a tube with the mirror plane y = 0: from inner (x, z) to outer (x, z), bulging to
/// `half_width`.
struct Rib {
  double inner_x, inner_z, outer_x, outer_z, half_width;
};

inline constexpr Ring kRim[4] = {
    {1.4, 0.784, 2.4}, {1.3375, 0.749, 2.53125}, {1.4375, 0.805, 2.53125}, {1.5, 0.84, 2.4}};
inline constexpr Ring kUpperBody[4] = {
    {1.5, 0.84, 2.4}, {1.75, 0.98, 1.875}, {2.0, 1.12, 1.35}, {2.0, 1.12, 0.9}};
inline constexpr Ring kLowerBody[4] = {
    {2.0, 1.12, 0.9}, {2.0, 1.12, 0.45}, {1.5, 0.84, 0.225}, {1.5, 0.84, 0.15}};
inline constexpr Ring kKnob[4] = {
    {0.0, 0.0, 3.15}, {0.8, 0.45, 3.15}, {0.0, 0.0, 2.85}, {0.2, 0.112, 2.7}};
inline constexpr Ring kLid[4] = {
    {0.2, 0.112, 2.7}, {0.4, 0.224, 2.55}, {1.3, 0.728, 2.55}, {1.3, 0.728, 2.4}};
inline constexpr Ring kBottom[4] = {
    {0.0, 0.0, 0.0}, {1.425, 0.798, 0.0}, {1.5, 0.84, 0.075}, {1.5, 0.84, 0.15}};

inline constexpr Rib kUpperHandle[4] = {{-1.6, 2.025, -1.5, 2.25, 0.3},
                                        {-2.3, 2.025, -2.5, 2.25, 0.3},
                                        {-2.7, 2.025, -3.0, 2.25, 0.3},
                                        {-2.7, 1.8, -3.0, 1.8, 0.3}};
inline constexpr Rib kLowerHandle[4] = {{-2.7, 1.8, -3.0, 1.8, 0.3},
                                        {-2.7, 1.575, -3.0, 1.35, 0.3},
                                        {-2.5, 1.125, -2.65, 0.9375, 0.3},
                                        {-2.0, 0.9, -1.9, 0.6, 0.3}};
inline constexpr Rib kLowerSpout[4] = {{1.7, 1.425, 1.7, 0.6, 0.66},
                                       {2.6, 1.425, 3.1, 0.825, 0.66},
                                       {2.3, 2.1, 2.4, 2.025, 0.25},
                                       {2.7, 2.4, 3.3, 2.4, 0.25}};
inline constexpr Rib kUpperSpout[4] = {{2.7, 2.4, 3.3, 2.4, 0.25},
                                       {2.8, 2.475, 3.525, 2.49375, 0.25},
                                       {2.9, 2.475, 3.45, 2.5125, 0.15},
                                       {2.8, 2.4, 3.2, 2.4, 0.15}};

}  // namespace teapot_data

/// The 32 patches in Newell's order: rim 4, body 8, handle 4, spout 4, lid 8, bottom 4.
[[nodiscard]] constexpr std::array<BezierPatch, 32> teapot_patches() {
  using namespace teapot_data;
  std::array<BezierPatch, 32> patches{};
  std::size_t next = 0;
  // `turn` is −1 where the columns run clockwise as seen from above, +1 for the bottom.
  const auto revolve = [&](const Ring(&rings)[4], double turn) {
    for (int quarter = 0; quarter < 4; ++quarter) {
      BezierPatch& patch = patches[next++];
      for (int row = 0; row < 4; ++row) {
        const Ring& r = rings[row];
        const double along[4][2] = {
            {r.radius, 0}, {r.radius, r.bulge}, {r.bulge, r.radius}, {0, r.radius}};
        for (int column = 0; column < 4; ++column) {
          double x = along[column][0], y = along[column][1];
          for (int q = 0; q < quarter; ++q) {
            const double old_x = x;
            x = -y;
            y = old_x;
          }
          patch.points[row][column] = {x, turn * y, r.z};
        }
      }
    }
  };
  const auto mirror = [&](const Rib(&ribs)[4]) {
    for (const double side : {-1.0, 1.0}) {
      BezierPatch& patch = patches[next++];
      for (int row = 0; row < 4; ++row) {
        const Rib& r = ribs[row];
        const Vec3d across[4] = {{r.inner_x, 0, r.inner_z},
                                 {r.inner_x, side * r.half_width, r.inner_z},
                                 {r.outer_x, side * r.half_width, r.outer_z},
                                 {r.outer_x, 0, r.outer_z}};
        for (int column = 0; column < 4; ++column)
          patch.points[row][column] = across[side < 0 ? column : 3 - column];
      }
    }
  };
  revolve(kRim, -1);
  revolve(kUpperBody, -1);
  revolve(kLowerBody, -1);
  mirror(kUpperHandle);
  mirror(kLowerHandle);
  mirror(kLowerSpout);
  mirror(kUpperSpout);
  revolve(kKnob, -1);
  revolve(kLid, -1);
  revolve(kBottom, 1);
  return patches;
}

}  // namespace rastrum::shapes
