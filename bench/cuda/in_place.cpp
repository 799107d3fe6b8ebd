#include "in_place.hpp"

#include <utility>

namespace rastrum::bench {
namespace {

RenderOptions in_place(RenderOptions options) {
  options.device = Device::cuda;
  options.in_place = true;
  return options;
}
std::size_t pixels_of(const RenderOptions& o) {
  return static_cast<std::size_t>(o.width) * static_cast<std::size_t>(o.height);
}
template <class T>
ImageView<T> view_of(const DeviceMemory& memory, const RenderOptions& o) {
  return {static_cast<T*>(memory.data()), o.width, o.height, o.width};
}

}  // namespace

void MeshesInPlace::add(const MeshView& mesh) {
  positions_.emplace_back(mesh.positions);
  indices_.emplace_back(mesh.indices);
  MeshView there;
  there.positions = positions_.back().view();
  there.indices = indices_.back().view();
  instances_.push_back({there, Mat4d::identity()});
}

InPlace::InPlace(const RenderOptions& options, const Camera& camera)
    : renderer_(in_place(options)), camera_(camera), color8_(pixels_of(options) * sizeof(Rgba8)) {}

FrameStats InPlace::draw(const MeshesInPlace& meshes, const Targets& targets) {
  return renderer_.render({meshes.instances(), {}, {}}, camera_, targets);
}

FrameStats InPlace::draw(const MeshesInPlace& meshes) {
  Targets targets;
  targets.color8 = view_of<Rgba8>(color8_, renderer_.options());
  return draw(meshes, targets);
}

template <class T>
Image<T> InPlace::drawn(const MeshesInPlace& meshes, ImageView<T> Targets::*target,
                        FrameStats& stats) {
  const RenderOptions& o = renderer_.options();
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
