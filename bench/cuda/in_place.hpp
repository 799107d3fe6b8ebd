// SPDX-License-Identifier: BSD-3-Clause
// Frames of meshes in a device's memory, into pictures there (Renderer::render_in_place), as a
// simulation on the device has them. The papers time such frames.
#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include <rastrum/camera.hpp>
#include <rastrum/family.hpp>
#include <rastrum/image.hpp>
#include <rastrum/mesh.hpp>

#include "device.hpp"

namespace rastrum::bench {

/// Positions and indices of meshes, which are drawn one after the other as one.
class MeshesInPlace {
 public:
  /// Copies a mesh to the device. Throws Error{out_of_memory}.
  void add(const MeshView& mesh);

  [[nodiscard]] const std::vector<InstanceView>& instances() const { return instances_; }

 private:
  std::vector<DeviceArray<Vec3>> positions_;
  std::vector<DeviceArray<std::uint32_t>> indices_;
  std::deque<MeshView> meshes_;
  std::vector<InstanceView> instances_;
};

/// A renderer with its picture on the device.
class InPlace {
 public:
  /// The options must name the device, and their shader must have a form for it.
  InPlace(const family::Options& options, const Camera& camera, int width, int height);

  /// Draws a frame to 8-bit colours.
  FrameStats draw(const MeshesInPlace& meshes);
  /// Draws a frame to visibility keys, or to ids.
  [[nodiscard]] Image<std::uint64_t> keys(const MeshesInPlace& meshes, FrameStats& stats);
  [[nodiscard]] Image<std::int64_t> ids(const MeshesInPlace& meshes, FrameStats& stats);

 private:
  FrameStats draw(const MeshesInPlace& meshes, const Targets& targets);
  template <class T>
  [[nodiscard]] Image<T> drawn(const MeshesInPlace& meshes, ImageView<T> Targets::*target,
                               FrameStats& stats);

  Renderer renderer_;
  FrameOptions frame_;
  Camera camera_;
  DeviceMemory color8_;
};

}  // namespace rastrum::bench
