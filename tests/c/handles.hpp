// SPDX-License-Identifier: BSD-3-Clause
// Handles of the C interface that free themselves, and pictures by them.
#pragma once

#include <memory>
#include <type_traits>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum.h>
#include <rastrum/raster/context/target_table.hpp>

#include "tests/support/frame.hpp"

namespace rastrum::test {

template <auto free>
struct Free {
  template <class Handle>
  void operator()(Handle* handle) const {
    free(handle);
  }
};
using CScene = std::unique_ptr<rastrum_scene, Free<rastrum_scene_free>>;
using CCamera = std::unique_ptr<rastrum_camera, Free<rastrum_camera_free>>;
using CFrame = std::unique_ptr<rastrum_frame, Free<rastrum_frame_free>>;
using CRenderer = std::unique_ptr<rastrum_renderer, Free<rastrum_renderer_free>>;

inline void expect_ok(rastrum_status status) {
  EXPECT_EQ(status, RASTRUM_OK) << rastrum_error_text();
}

inline constexpr rastrum_array kNone{nullptr, 0, 0, 0, 0};

template <class T>
constexpr int kNumberType = std::is_same_v<T, float>           ? RASTRUM_FLOAT32
                            : std::is_same_v<T, double>        ? RASTRUM_FLOAT64
                            : std::is_same_v<T, std::uint8_t>  ? RASTRUM_UINT8
                            : std::is_same_v<T, std::int8_t>   ? RASTRUM_INT8
                            : std::is_same_v<T, std::uint16_t> ? RASTRUM_UINT16
                            : std::is_same_v<T, std::int16_t>  ? RASTRUM_INT16
                            : std::is_same_v<T, std::uint32_t> ? RASTRUM_UINT32
                            : std::is_same_v<T, std::int32_t>  ? RASTRUM_INT32
                            : std::is_same_v<T, std::uint64_t> ? RASTRUM_UINT64
                                                               : RASTRUM_INT64;

/// Packed numbers, `channels` per value.
template <class T>
[[nodiscard]] rastrum_array array_of(const std::vector<T>& numbers, int channels = 1) {
  return {numbers.data(), numbers.size() / static_cast<std::size_t>(channels), kNumberType<T>,
          channels, 0};
}
[[nodiscard]] inline rastrum_array array_of(const std::vector<Vec3>& vectors) {
  return {vectors.data(), vectors.size(), RASTRUM_FLOAT32, 3, 0};
}

/// A new camera, frame and renderer.
struct CPicture {
  int width, height;
  CScene scene{rastrum_scene_new()};
  CCamera camera{rastrum_camera_new()};
  CFrame frame{rastrum_frame_new(width, height)};
  CRenderer renderer{rastrum_renderer_new()};

  [[nodiscard]] rastrum_status render() const {
    return rastrum_render(renderer.get(), scene.get(), camera.get(), frame.get());
  }
  /// The images of these kinds (frame.hpp).
  [[nodiscard]] Frame draw(unsigned kinds) const {
    Frame images(width, height, kinds);
    const Targets targets = images.targets();
    raster::for_each_target([&]<class T>(const raster::TargetRow<T>& row) {
      const ImageView<T>& image = targets.*row.image;
      const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
      expect_ok(rastrum_frame_set_target(frame.get(), std::string(row.name).c_str(), image.data,
                                         image.empty() ? 0 : pixels * sizeof(T), 0));
    });
    expect_ok(render());
    return images;
  }
};

}  // namespace rastrum::test
