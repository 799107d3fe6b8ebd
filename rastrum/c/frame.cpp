// SPDX-License-Identifier: BSD-3-Clause
// Frames of the C interface: options, and targets by name.
#include <rastrum/c/handles.hpp>

#include <algorithm>
#include <cstdlib>
#include <string>
#include <string_view>
#include <utility>

#include <rastrum/array.hpp>
#include <rastrum/core/view_rows.hpp>
#include <rastrum/digest.hpp>
#include <rastrum/error.hpp>
#include <rastrum/light.hpp>
#include <rastrum/raster/context/target_table.hpp>

namespace rastrum::c {

static_assert(RASTRUM_CULL_NONE == static_cast<int>(Cull::none) &&
              RASTRUM_CULL_BACK == static_cast<int>(Cull::back) &&
              RASTRUM_CULL_FRONT == static_cast<int>(Cull::front));

namespace {

/// Changes options by f(options); keeps them if they pass check().
template <class F>
rastrum_status with_frame(rastrum_frame* frame, const F& f) noexcept {
  return guarded([&] {
    FrameOptions changed = at(frame, "the frame").options;
    f(changed);
    check(changed);
    frame->options = std::move(changed);
  });
}

/// Calls f(row) for the target `name`. Throws Error{not_found}.
template <class F>
void for_target(const char* name, const F& f) {
  const std::string_view wanted = &at(name, "the name of the target");
  bool found = false;
  std::string known;
  raster::for_each_target([&](const auto& row) {
    if (row.name == wanted) f(row);
    found = found || row.name == wanted;
    known.append(known.empty() ? "" : ", ").append(row.name);
  });
  if (!found)
    throw Error(Errc::not_found, text_of("no target is called '", wanted, "'; there are ", known));
}

/// The numbers of a pixel; floats by default.
struct PixelNumbers {
  int type, channels;
};
template <class T>
constexpr PixelNumbers kNumbers{RASTRUM_FLOAT32, sizeof(T) / sizeof(float)};
template <>
constexpr PixelNumbers kNumbers<Rgba8>{RASTRUM_UINT8, 4};
template <>
constexpr PixelNumbers kNumbers<std::uint8_t>{RASTRUM_UINT8, 1};
template <>
constexpr PixelNumbers kNumbers<std::uint32_t>{RASTRUM_UINT32, 1};
template <>
constexpr PixelNumbers kNumbers<std::uint64_t>{RASTRUM_UINT64, 1};
template <>
constexpr PixelNumbers kNumbers<std::int32_t>{RASTRUM_INT32, 1};
template <>
constexpr PixelNumbers kNumbers<std::int64_t>{RASTRUM_INT64, 1};

/// An image of the frame's size in memory whose size the caller gives.
template <class T>
ImageView<T> image_in(void* pixels, std::size_t bytes, std::ptrdiff_t stride_bytes,
                      const FrameOptions& o, std::string_view name) {
  constexpr std::ptrdiff_t kPixel = sizeof(T);
  if (pixels == nullptr && bytes == 0) return {};
  require(pixels != nullptr, "the ", name, " target is null, but has ", bytes, " bytes");
  require(stride_bytes % kPixel == 0 && array_detail::is_aligned(pixels, alignof(T)), "the ", name,
          " target: its rows must begin where a pixel of ", kPixel, " bytes can");
  ImageView<T> image{static_cast<T*>(pixels), o.width, o.height};
  if (stride_bytes != 0) image.stride = stride_bytes / kPixel;
  check_stride(image, text_of("the ", name, " target"));

  const auto row = static_cast<std::size_t>(o.width * kPixel);
  const auto step = static_cast<std::size_t>(std::abs(image.stride) * kPixel);
  const auto steps = static_cast<std::size_t>(o.height - 1);
  const bool fits = bytes >= row && (steps == 0 || (bytes - row) / steps >= step);
  require(fits && (stride_bytes != 0 || bytes == row + steps * step), "the ", name, " target of ",
          o.width, " x ", o.height, " pixels takes ", row + steps * step, " bytes, not ", bytes,
          ": each pixel has ", kPixel);
  return image;
}

}  // namespace

#pragma GCC visibility push( \
    default)  // as in rastrum.h, whose declarations are in another namespace
extern "C" {

rastrum_frame* rastrum_frame_new(int width, int height) {
  return made([&] {
    check_image_size(width, height);
    return new rastrum_frame{{.width = width, .height = height}, {}, {}};
  });
}

void rastrum_frame_free(rastrum_frame* frame) {
  delete frame;
}

rastrum_status rastrum_frame_set_shader(rastrum_frame* frame, const char* shader) {
  return with_frame(frame, [&](FrameOptions& o) {
    o.shader = shader_from_name(&at(shader, "the name of the shader"));
  });
}

rastrum_status rastrum_frame_set_background(rastrum_frame* frame, const float rgba[4]) {
  return with_frame(frame, [&](FrameOptions& o) { o.background = vec4(rgba, "rgba"); });
}

rastrum_status rastrum_frame_set_samples(rastrum_frame* frame, int samples) {
  return with_frame(frame, [&](FrameOptions& o) { o.samples = samples; });
}

rastrum_status rastrum_frame_set_opacity(rastrum_frame* frame, float opacity) {
  return with_frame(frame, [&](FrameOptions& o) { o.opacity = opacity; });
}

rastrum_status rastrum_frame_set_cull(rastrum_frame* frame, int cull) {
  return with_frame(frame, [&](FrameOptions& o) { o.cull = to_enum<Cull>(cull); });
}

rastrum_status rastrum_frame_set_clip_planes(rastrum_frame* frame, const double* planes,
                                             size_t count) {
  return with_frame(frame, [&](FrameOptions& o) {
    require(planes != nullptr || count == 0, "the clip planes are null");
    require(count <= kMaxClipPlanes, "there are ", count, " clip planes, and may be ",
            kMaxClipPlanes);
    o.clip_planes.clear();
    for (std::size_t i = 0; i < count; ++i)
      o.clip_planes.push_back({vec3(planes + 4 * i, "a plane"), planes[4 * i + 3]});
  });
}

rastrum_status rastrum_frame_add_light(rastrum_frame* frame, int kind, const double vector[3],
                                       const float rgb[3], float intensity, int of_camera) {
  return with_frame(frame, [&](FrameOptions& o) {
    (void)at(rgb, "rgb");
    Light light{
        .color = {rgb[0], rgb[1], rgb[2]}, .intensity = intensity, .of_camera = of_camera != 0};
    switch (kind) {
      case RASTRUM_LIGHT_AMBIENT:
        light.kind = AmbientLight{};
        break;
      case RASTRUM_LIGHT_DIRECTIONAL:
        light.kind = DirectionalLight{Vec3(vec3(vector, "the direction of a light"))};
        break;
      case RASTRUM_LIGHT_POINT:
        light.kind = PointLight{.position = vec3(vector, "the place of a light")};
        break;
      default:
        reject("no kind of light has the number ", kind);
    }
    o.lights.push_back(light);
  });
}

rastrum_status rastrum_frame_set_shadows(rastrum_frame* frame, int shadows) {
  return with_frame(frame, [&](FrameOptions& o) { o.shadows = shadows != 0; });
}

rastrum_status rastrum_frame_set_target(rastrum_frame* frame, const char* target, void* pixels,
                                        size_t bytes, ptrdiff_t stride_bytes) {
  return guarded([&] {
    rastrum_frame& f = at(frame, "the frame");
    for_target(target, [&]<class T>(const raster::TargetRow<T>& row) {
      f.targets.*row.image = image_in<T>(pixels, bytes, stride_bytes, f.options, row.name);
    });
  });
}

rastrum_status rastrum_target_type(const char* target, int* type, int* channels) {
  return guarded([&] {
    for_target(target, [&]<class T>(const raster::TargetRow<T>&) {
      at(type, "type") = kNumbers<T>.type;
      at(channels, "channels") = kNumbers<T>.channels;
    });
  });
}

rastrum_status rastrum_frame_digest(const rastrum_frame* frame, const char* target,
                                    char digest[65]) {
  return guarded([&] {
    const rastrum_frame& f = at(frame, "the frame");
    for_target(target, [&]<class T>(const raster::TargetRow<T>& row) {
      const ImageView<T>& image = f.targets.*row.image;
      require(!image.empty(), "the frame has no ", row.name, " target");
      const std::string hex = rastrum::digest(ImageView<const T>(image)).hex();
      std::copy_n(hex.c_str(), hex.size() + 1, &at(digest, "digest"));
    });
  });
}

rastrum_status rastrum_frame_set_stopped(rastrum_frame* frame, int stopped) {
  return guarded([&] {
    rastrum_frame& f = at(frame, "the frame");
    if (stopped != 0)
      f.stop.request_stop();
    else if (f.stop.stop_requested())
      f.stop = std::stop_source();
  });
}

}  // extern "C"
#pragma GCC visibility pop
}  // namespace rastrum::c
