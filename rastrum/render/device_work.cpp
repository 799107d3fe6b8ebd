// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/render/device_work.hpp>

#include <rastrum/core/number_text.hpp>

namespace rastrum {
namespace {

// One thread's time, within a factor of 2.5 of the first table in docs/log/triangles.md: from 968
// triangles at 4096² (pixels) to 4.4 million (primitives), except for a soup of a million large
// ones, whose samples are not known beforehand.
constexpr double kHostPrimitive_ns = 50, kHostPixel_ns = 4;
// An H200's time, within a third of `rastrum bench cuda-frames` in place from 70 thousand to 18
// million triangles.
constexpr double kDevicePrimitive_ns = 0.04, kDevicePixel_ns = 0.02;
/// Kernels, copies and a wait of a frame in one band.
constexpr std::uint64_t kLaunches = 16;
/// A position and a normal. The frame does not tell other attributes.
constexpr std::uint64_t kVertexBytes = 24;

template <class T>
std::uint64_t bytes_a_pixel(const ImageView<T>& target) {
  return target.empty() ? 0 : sizeof(T);
}

}  // namespace

FrameWork device_work(const raster::FrameRequest& request) {
  const Targets& t = request.targets;
  std::uint64_t primitives = 0;
  FrameWork work;
  for (const raster::Draw& draw : request.draws) {
    primitives += draw.primitive_count;
    work.bytes += draw.vertex_count * kVertexBytes + draw.indices.size_bytes();
  }
  const std::uint64_t pixels =
      static_cast<std::uint64_t>(request.width) * static_cast<std::uint64_t>(request.height);
  work.bytes +=
      pixels * (bytes_a_pixel(t.color8) + bytes_a_pixel(t.color) + bytes_a_pixel(t.depth) +
                bytes_a_pixel(t.ids) + bytes_a_pixel(t.overdraw) +
                bytes_a_pixel(t.keys) * (request.pass.load ? 2 : 1));
  work.what = text_of(primitives, " primitives at ", request.width, "x", request.height);
  const auto n = static_cast<double>(primitives), p = static_cast<double>(pixels);
  work.host_ns = kHostPrimitive_ns * n + kHostPixel_ns * p;
  work.device_ns = kDevicePrimitive_ns * n + kDevicePixel_ns * p;
  work.launches = kLaunches;
  return work;
}

}  // namespace rastrum
