// SPDX-License-Identifier: BSD-3-Clause
// Several samples a pixel on a device. The surface has a plane of keys for each sample (cover.cuh).
// Here they become planes of colours and then one picture.
//
// As on the host, a triangle has one colour in a pixel: at the centre or, if it misses that, at the
// first sample that it covers. A key does not say which, so the triangle is assembled again: a
// thread that shades reads its vertices anyway. The opaque surface is shaded once for each triangle
// and pixel, layers once for four samples.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <rastrum/parallel/cuda/words.cuh>
#include <rastrum/raster/cuda/cover.cuh>
#include <rastrum/raster/cuda/geometry.cuh>
#include <rastrum/raster/setup/assemble.hpp>

namespace rastrum::raster {

/// Where a primitive is shaded in a pixel; it covers a sample of it.
struct ShadingPlace {
  std::uint64_t key;  ///< there
  Vec2 from_centre;   ///< px
};

/// Out of line: it contains the clipper.
[[nodiscard]] RASTRUM_HD_CALL ShadingPlace shading_place(const DeviceGeometry& geometry,
                                                         const SamplePattern& samples,
                                                         std::uint64_t id, int x, int y) {
  const Draw& draw = geometry.draw_of(id);
  ShadingPlace place{kIdMask - id, {0, 0}};
  for (int s = -1; s < samples.count; ++s) {
    const SampleOffset at = s < 0 ? SampleOffset{} : samples.at[s];
    bool found = false;
    const auto look = [&](const Piece& piece) {
      if (!covers_centre(edges_of(piece), x, y)) return;
      constexpr float kPx = 1.0F / kSubpixels;
      const std::uint64_t key = make_key(depth_at(piece, x, y), piece.low);
      // The nearest, where pieces of a clipped triangle overlap.
      if (found && key <= place.key) return;
      place = {key, {static_cast<float>(at.x) * kPx, static_cast<float>(at.y) * kPx}};
      found = true;
    };
    assemble_primitive(geometry, draw, id - draw.first_id, look, 0, at);
    if (found) break;
  }
  return place;
}

/// Turns a shader with a place, (key, x, y, from_centre), into one for any sample, (key, x, y),
/// whose key only names the primitive.
template <class Shade>
struct ShadedOnce {
  DeviceGeometry geometry;
  SamplePattern samples;
  Shade shade;
  RASTRUM_HD Vec4 operator()(std::uint64_t key, int x, int y) const {
    const ShadingPlace place = shading_place(geometry, samples, id_of_key(key), x, y);
    return shade(place.key, x, y, place.from_centre);
  }
  /// For a caller that has a piece of the primitive, relative to pixel centres: most pieces cover
  /// them.
  RASTRUM_HD Vec4 operator()(const Piece& piece, std::uint64_t key, int x, int y) const {
    const ShadingPlace place =
        covers_centre(edges_of(piece), x, y)
            ? ShadingPlace{make_key(depth_at(piece, x, y), piece.low), {0, 0}}
            : shading_place(geometry, samples, id_of_key(key), x, y);
    return shade(place.key, x, y, place.from_centre);
  }
  /// With what was read of the primitive before.
  using Record = typename Shade::Record;
  RASTRUM_HD Vec4 operator()(const Piece& piece, const Record& record, std::uint64_t key, int x,
                             int y) const {
    if (covers_centre(edges_of(piece), x, y))
      return shade(record, make_key(depth_at(piece, x, y), piece.low), x, y);
    const ShadingPlace place = shading_place(geometry, samples, id_of_key(key), x, y);
    return shade(record, place.key, x, y, place.from_centre);
  }
  [[nodiscard]] bool wants_records() const { return shade.wants_records(); }
  RASTRUM_HD Record record(std::uint64_t low) const { return shade.record(low); }
};

template <class Shade>
inline constexpr bool kIsShadedOnce = false;
template <class Shade>
inline constexpr bool kIsShadedOnce<ShadedOnce<Shade>> = true;

namespace cuda_detail {

/// The colours of element i in all planes; 0 without a key.
template <class Shade>
struct ShadeSamples {
  DeviceSurface surface;
  Vec4* colors;
  Shade shade;
  RASTRUM_HD void operator()(std::size_t i) const {
    const auto [x, y] = surface.keys.place_of(i);
    for (int s = 0; s < surface.samples.count; ++s) {
      const std::uint64_t key = surface.plane_of(s)[i];
      Vec4& color = colors[static_cast<std::size_t>(s) * surface.plane + i];
      int same = 0;
      while (same < s && ((surface.plane_of(same)[i] ^ key) & kIdMask) != 0) ++same;
      if (key == 0)
        color = {};
      else if (same < s)
        color = colors[static_cast<std::size_t>(same) * surface.plane + i];
      else
        color = shade(key, x, y);
    }
  }
};

struct MeanOfSamples {
  DeviceSurface surface;
  Vec4* colors;
  const std::uint64_t* held;
  RASTRUM_HD void operator()(std::size_t i) const {
    if (held != nullptr && *held != 0) return;
    Vec4 sum{0, 0, 0, 0};
    std::uint64_t nearest = 0;
    for (int s = 0; s < surface.samples.count; ++s) {
      const std::uint64_t key = surface.plane_of(s)[i];
      nearest = key > nearest ? key : nearest;
      sum = sum + colors[static_cast<std::size_t>(s) * surface.plane + i];
    }
    surface.plane_of(0)[i] = nearest;
    colors[i] = sum * (1.0F / static_cast<float>(surface.samples.count));
  }
};

}  // namespace cuda_detail

/// Colours of an opaque surface, in planes like its keys. `shade`: (key, x, y) → premultiplied Vec4
/// of a primitive in a pixel (ShadedOnce). Work O(pixels · samples); each primitive of a pixel is
/// shaded once.
template <class Exec, class Shade>
void shade_samples(Exec& exec, const DeviceSurface& surface, std::span<Vec4> colors,
                   const Shade& shade) {
  parallel::for_each_index(exec, surface.plane,
                           cuda_detail::ShadeSamples<Shade>{surface, colors.data(), shade});
}

/// Makes the first plane the picture: each pixel's largest key and mean colour. Does nothing if
/// *held, on the device, is not 0; null: there is none.
template <class Exec>
void mean_of_samples(Exec& exec, const DeviceSurface& surface, std::span<Vec4> colors,
                     const std::uint64_t* held = nullptr) {
  parallel::for_each_index(exec, surface.plane,
                           cuda_detail::MeanOfSamples{surface, colors.data(), held});
}

}  // namespace rastrum::raster
