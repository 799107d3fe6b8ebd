// SPDX-License-Identifier: BSD-3-Clause
// The images of one frame, and the differences between two.
#pragma once

#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>
#include <type_traits>

#include <gtest/gtest.h>

#include <rastrum/render.hpp>

#include "tests/support/oracle.hpp"
#include "tests/support/painter.hpp"

namespace rastrum::test {

/// The images of a frame. They decide how the frame is drawn.
enum ImageKinds : unsigned {
  kColor8 = 1U << 0,
  kColor = 1U << 1,
  kIds = 1U << 2,
  kDepth = 1U << 3,
  kOverdraw = 1U << 4,
  kInstances = 1U << 5,
  kPrimitives = 1U << 6,
  kBarycentrics = 1U << 7,
  kPositions = 1U << 8,
  kNormals = 1U << 9,
  kCameraNormals = 1U << 10,
  kViewDepth = 1U << 11,
  kDistance = 1U << 12,
  kAlbedo = 1U << 13,
  kScalars = 1U << 14,
  kLinear = 1U << 15,
  kErrors = 1U << 16,
  kVisible = kIds | kDepth,
  kPicture = kColor8 | kColor | kIds | kDepth,
  kCounted = kPicture | kOverdraw,
  kSurfaces = kIds | kDepth | kInstances | kPrimitives | kBarycentrics | kPositions | kNormals |
              kCameraNormals | kViewDepth | kDistance | kAlbedo,
};

struct Frame {
  Image<Rgba8> color8;
  Image<Vec4> color;
  Image<std::int64_t> ids;
  Image<float> depth;
  Image<std::uint32_t> overdraw;
  Image<std::int64_t> instances, primitives;
  Image<Vec2> barycentrics;
  Image<Vec3> positions, normals, camera_normals;
  Image<float> view_depth, distance;
  Image<Vec4> albedo;
  Image<float> scalars;
  Image<Vec4> linear;
  Image<std::uint8_t> errors;
  FrameStats stats;

  Frame() = default;
  /// `kinds`: of ImageKinds. The images begin with nonsense, so that unwritten pixels show.
  Frame(int width, int height, unsigned kinds);
  [[nodiscard]] Targets targets();
};

/// Calls f(kind, name, Frame's member, Targets' member) for each.
template <class F>
void for_each_kind(const F& f) {
  f(kColor8, "8-bit colour", &Frame::color8, &Targets::color8);
  f(kColor, "float colour", &Frame::color, &Targets::color);
  f(kIds, "ids", &Frame::ids, &Targets::ids);
  f(kDepth, "depth", &Frame::depth, &Targets::depth);
  f(kOverdraw, "overdraw", &Frame::overdraw, &Targets::overdraw);
  f(kInstances, "instances", &Frame::instances, &Targets::instances);
  f(kPrimitives, "primitives", &Frame::primitives, &Targets::primitives);
  f(kBarycentrics, "barycentrics", &Frame::barycentrics, &Targets::barycentrics);
  f(kPositions, "positions", &Frame::positions, &Targets::positions);
  f(kNormals, "normals", &Frame::normals, &Targets::normals);
  f(kCameraNormals, "camera_normals", &Frame::camera_normals, &Targets::camera_normals);
  f(kViewDepth, "view_depth", &Frame::view_depth, &Targets::view_depth);
  f(kDistance, "distance", &Frame::distance, &Targets::distance);
  f(kAlbedo, "albedo", &Frame::albedo, &Targets::albedo);
  f(kScalars, "scalars", &Frame::scalars, &Targets::scalars);
  f(kLinear, "linear", &Frame::linear, &Targets::linear);
  f(kErrors, "errors", &Frame::errors, &Targets::errors);
}

[[nodiscard]] Frame draw(Renderer& renderer, const SceneView& scene, const Camera& camera,
                         const FrameOptions& frame, unsigned kinds = kPicture);
[[nodiscard]] Frame draw(Painter& renderer, const SceneView& scene, const Camera& camera,
                         unsigned kinds = kCounted);
[[nodiscard]] Frame draw(Painter& renderer, std::span<raster::Draw> draws,
                         const raster::Shading& shader, const raster::Testing& test);
/// Draws with a renderer of its own.
[[nodiscard]] Frame draw(const RendererOptions& by, const SceneView& scene, const Camera& camera,
                         const FrameOptions& frame, unsigned kinds = kPicture);
[[nodiscard]] Frame draw(const RenderOptions& options, const SceneView& scene, const Camera& camera,
                         unsigned kinds = kCounted);
[[nodiscard]] Frame draw(const RenderOptions& options, const Scene& scene, const Camera& camera);

/// Compares all bits, except a NaN's sign and payload, which depend on the processor
/// (docs/conventions.md).
template <class T>
[[nodiscard]] bool same_pixel(const T& a, const T& b) {
  if (std::memcmp(&a, &b, sizeof a) == 0) return true;
  if constexpr (std::is_integral_v<T> || std::is_same_v<T, Rgba8>) {
    return false;
  } else {
    constexpr std::size_t kNumbers = sizeof(T) / sizeof(float);
    float p[kNumbers], q[kNumbers];
    std::memcpy(p, &a, sizeof a);
    std::memcpy(q, &b, sizeof b);
    for (std::size_t i = 0; i < kNumbers; ++i)
      if (std::memcmp(&p[i], &q[i], sizeof(float)) != 0 && (p[i] == p[i] || q[i] == q[i]))
        return false;
    return true;
  }
}

/// Whether all images of these kinds that one of the two has are equal. The message names the first
/// differing pixel.
[[nodiscard]] testing::AssertionResult same_images(const Frame& a, const Frame& b,
                                                   unsigned kinds = ~0U);
/// The images and the counters.
[[nodiscard]] testing::AssertionResult same_frames(const Frame& a, const Frame& b);
/// Ids, depth and overdraw.
[[nodiscard]] testing::AssertionResult same_surfaces(const Frame& a, const Frame& b);
[[nodiscard]] testing::AssertionResult same_surfaces(const Frame& a, const OracleImage& b);
/// With `tolerance` 0, compares the bits of all colours, 8 bits and float32. Otherwise no 8-bit
/// channel may differ by more than `tolerance`.
[[nodiscard]] testing::AssertionResult same_picture(const Frame& a, const Frame& b, int tolerance);
/// Compares the counters, and checks that each frame's add up.
[[nodiscard]] testing::AssertionResult same_counts(const FrameStats& a, const FrameStats& b);
/// For EveryWay::same, which compares the images itself.
inline constexpr auto kCountsToo = [](const Frame& got, const Frame& expected) {
  EXPECT_TRUE(same_counts(got.stats, expected.stats));
};
/// The same without fragments, whose number depends on what is hidden early.
[[nodiscard]] testing::AssertionResult same_triangles(const FrameStats& a, const FrameStats& b);
[[nodiscard]] testing::AssertionResult counts_add_up(const Frame& frame);
/// The counter of that name; a frame without it fails the test.
[[nodiscard]] std::uint64_t counter(const FrameStats& stats, std::string_view name);

}  // namespace rastrum::test
