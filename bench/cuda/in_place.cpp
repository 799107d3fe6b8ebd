// SPDX-License-Identifier: BSD-3-Clause
#include "in_place.hpp"

namespace rastrum::bench {
namespace {

Renderer renderer_there(family::Options options) {
  options.device = Device::cuda;
  return family::make_renderer(options, options);
}
FrameOptions of_size(FrameOptions frame, int width, int height) {
  frame.width = width;
  frame.height = height;
  return frame;
}
std::size_t pixels_of(const FrameOptions& o) {
  return static_cast<std::size_t>(o.width) * static_cast<std::size_t>(o.height);
}
template <class T>
ImageView<T> view_of(const DeviceMemory& memory, const FrameOptions& o) {
  return {static_cast<T*>(memory.data()), o.width, o.height, o.width};
}

}  // namespace

void MeshesInPlace::add(const MeshView& mesh) {
  positions_.emplace_back(mesh.positions.packed());
  indices_.emplace_back(mesh.indices.packed());
  MeshView& there = meshes_.emplace_back();
  there.positions = positions_.back().view();
  there.indices = indices_.back().view();
  instances_.push_back({there});
}

InPlace::InPlace(const family::Options& options, const Camera& camera, int width, int height)
    : renderer_(renderer_there(options)),
      frame_(of_size(options, width, height)),
      camera_(camera),
      color8_(pixels_of(frame_) * sizeof(Rgba8)) {}

FrameStats InPlace::draw(const MeshesInPlace& meshes, const Targets& targets) {
  return renderer_.render_in_place({.instances = meshes.instances()}, camera_, frame_, targets);
}

FrameStats InPlace::draw(const MeshesInPlace& meshes) {
  return draw(meshes, {.color8 = view_of<Rgba8>(color8_, frame_)});
}

template <class T>
Image<T> InPlace::drawn(const MeshesInPlace& meshes, ImageView<T> Targets::*target,
                        FrameStats& stats) {
  const FrameOptions& o = frame_;
  const DeviceMemory memory(pixels_of(o) * sizeof(T));
  Targets targets;
  targets.*target = view_of<T>(memory, o);
  stats = draw(meshes, targets);
  Image<T> image(o.width, o.height);
  memory.read(image.pixels().data(), image.pixels().size_bytes());
  return image;
}

Image<std::uint64_t> InPlace::keys(const MeshesInPlace& meshes, FrameStats& stats) {
  return drawn(meshes, &Targets::keys, stats);
}
Image<std::int64_t> InPlace::ids(const MeshesInPlace& meshes, FrameStats& stats) {
  return drawn(meshes, &Targets::ids, stats);
}

}  // namespace rastrum::bench
