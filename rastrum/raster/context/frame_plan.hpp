// SPDX-License-Identifier: BSD-3-Clause
// The way that a frame takes, decided once (render/drawer.cpp): who draws it, which pixels it
// writes and who makes their colours. The stages read it and ask the request for none of this.
#pragma once

#include <cstdint>
#include <string>

#include <rastrum/raster/context/request.hpp>
#include <rastrum/raster/rules/color.hpp>

namespace rastrum::raster {

struct FramePlan {
  /// The surfaces that are found at a pixel.
  enum class Path : std::uint8_t {
    keys,     ///< the greatest key
    samples,  ///< the greatest key of each sample (frame/sampled_path.hpp)
    layers,   ///< all fragments, in order
    device,   ///< those that a device finds
  };
  enum class Colors : std::uint8_t {
    none,    ///< no image has any
    method,  ///< made with the visibility: layers, several samples
    block,   ///< from the keys of a block
    bin,     ///< the same, where a bin's triangles may be set up before (surface/seen_bin.hpp)
  };
  enum class Writes : std::uint8_t {
    all,       ///< all pixels: where no surface is, the background
    surfaces,  ///< where a surface is, over a picture (Pass::over)
    nearer,    ///< where one is that no pass before hides (Pass::load)
  };

  Path path = Path::keys;
  std::string why{};         ///< FrameStats::why
  std::string device_why{};  ///< FrameStats::device_why; empty: no device was to be chosen

  Rect drawn{};  ///< the image or a part of it
  Colors colors = Colors::none;
  bool at_once = false;  ///< shaders may write the 8-bit colours of a block themselves
  bool streams = false;  ///< 8-bit colours of whole lines go past the caches (Kernels::stream)
  Writes writes = Writes::all;
  Translucent translucent = Translucent::blended;
  bool stores = false;   ///< something of a surface
  bool keys = false;     ///< of it what its key tells
  bool surface = false;  ///< and properties of it (resolve/surface_point.hpp)
  bool normals = false;  ///< among them
  bool tests = false;    ///< some piece may be tested (FrameRequest::kept)
  bool hides = false;    ///< what is hidden may be left out, for nothing counts it
  Backdrop backdrop{};   ///< what colours are drawn over
  Vec4 background{};     ///< of pixels without a surface: premultiplied display values

  /// All of it but the path and its reasons. `method_shades`: colours are made with the visibility;
  /// `limits_memory`: that of each thread is planned.
  [[nodiscard]] static FramePlan of(const FrameRequest& request, bool method_shades,
                                    bool limits_memory);
};

/// `background`: display values with straight alpha. Costs three powers in linear light.
[[nodiscard]] Backdrop backdrop_of(Vec4 background, bool linear_light);

}  // namespace rastrum::raster
