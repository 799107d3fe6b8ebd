// All the images of one frame, and what differs between two of them.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include <gtest/gtest.h>

#include <rastrum/render.hpp>

#include "tests/support/oracle.hpp"
#include "tests/support/painter.hpp"

namespace rastrum::test {

struct Frame {
  Image<Rgba8> color8;
  Image<Vec4> color;
  Image<float> depth;
  Image<std::int64_t> ids;
  Image<std::uint32_t> overdraw;
  FrameStats stats;
};

/// Draws into images that hold nonsense before, so that a pixel which nobody wrote shows.
[[nodiscard]] Frame draw(Painter& renderer, const SceneView& scene, const Camera& camera);
[[nodiscard]] Frame draw(Painter& renderer, std::span<raster::Draw> draws,
                         const raster::BlockShader& shader, const raster::FragmentTest* test);
[[nodiscard]] Frame draw(const RenderOptions& options, const Scene& scene, const Camera& camera);

/// Ids, depth (bits) and overdraw equal; the message names the first pixel that differs.
[[nodiscard]] testing::AssertionResult same_surfaces(const Frame& a, const Frame& b);
[[nodiscard]] testing::AssertionResult same_surfaces(const Frame& a, const OracleImage& b);
/// With a `tolerance` of 0 all colours, 8 bits and float32, are the same bits. Else no channel of
/// the 8-bit picture differs by more than `tolerance`.
[[nodiscard]] testing::AssertionResult same_picture(const Frame& a, const Frame& b, int tolerance);
/// The counters of the two frames, and within each that they add up.
[[nodiscard]] testing::AssertionResult same_counts(const FrameStats& a, const FrameStats& b);
[[nodiscard]] testing::AssertionResult counts_add_up(const Frame& frame);
/// The counter of that name; a frame without it fails the test.
[[nodiscard]] std::uint64_t counter(const FrameStats& stats, std::string_view name);

}  // namespace rastrum::test
