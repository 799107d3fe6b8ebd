// SPDX-License-Identifier: BSD-3-Clause
// How a frame is drawn, decided once (render/drawer.cpp): who draws it, which pixels it writes and
// who makes their colours. The stages read these decisions here, not from the request.
#pragma once

#include <cstdint>
#include <string>

#include <rastrum/raster/context/request.hpp>
#include <rastrum/raster/rules/color.hpp>

namespace rastrum::raster {

struct FramePlan {
  /// Which surfaces a pixel finds.
  enum class Path : std::uint8_t {
    keys,     ///< the greatest key
    samples,  ///< the greatest key of each sample (frame/sampled_path.hpp)
    layers,   ///< all fragments, in order
    device,   ///< as the device finds them
  };
  enum class Colors : std::uint8_t {
    none,    ///< no image has colours
    method,  ///< made with visibility: layers, several samples
    block,   ///< from the keys of a block
    bin,     ///< the same; a bin's triangles may be set up before (surface/seen_bin.hpp)
  };
  enum class Writes : std::uint8_t {
    all,       ///< all pixels, the background where no surface is
    surfaces,  ///< where a surface is, over a picture (Pass::over)
    nearer,    ///< where a surface is that no earlier pass hides (Pass::load)
  };

  Path path = Path::keys;
  std::string why{};         ///< FrameStats::why
  std::string device_why{};  ///< FrameStats::device_why; empty: no device was to be chosen

  Rect drawn{};  ///< the image or a part of it
  Colors colors = Colors::none;
  bool at_once = false;  ///< shaders may write a block's 8-bit colours themselves
  bool streams = false;  ///< 8-bit colours of whole lines bypass the caches (Kernels::stream)
  Writes writes = Writes::all;
  Translucent translucent = Translucent::blended;
  bool stores = false;   ///< some target is made from surfaces
  bool keys = false;     ///< some from keys alone
  bool surface = false;  ///< some from surface points (resolve/surface_point.hpp)
  bool normals = false;  ///< some are normals
  bool tests = false;    ///< some piece may be tested (FrameRequest::kept)
  bool hides = false;    ///< what is hidden may be left out, since nothing counts it
  Backdrop backdrop{};   ///< what colours are drawn over
  Vec4 background{};     ///< of pixels without a surface: premultiplied display values

  /// All but the path and its reasons. `method_shades`: colours are made with visibility.
  /// `limits_memory`: the memory of each thread is planned.
  [[nodiscard]] static FramePlan of(const FrameRequest& request, bool method_shades,
                                    bool limits_memory);
};

/// `background`: display values with straight alpha. Costs three powers in linear light.
[[nodiscard]] Backdrop backdrop_of(Vec4 background, bool linear_light);

}  // namespace rastrum::raster
