// SPDX-License-Identifier: BSD-3-Clause
// The table of a frame's images, one row each, from which every list of images is made. A new
// output is a member of Targets, a row here, and a function that fills it (resolve/surfaces.cpp).
#pragma once

#include <cstdint>
#include <limits>
#include <string_view>
#include <type_traits>

#include <rastrum/frame.hpp>
#include <rastrum/image.hpp>
#include <rastrum/raster/rules/piece.hpp>
#include <rastrum/vec.hpp>

namespace rastrum::raster {

enum class TargetKind : std::uint8_t {
  color,     ///< the shaded colour; the background where nothing is
  key,       ///< what keys tell
  count,     ///< all fragments, hidden or not
  number,    ///< number of the surface at the pixel; programs have these, too
  surface,   ///< property of the surface at the pixel; scenes only
  normal,    ///< its normal, or what follows from it
  distance,  ///< its distance; FrameOptions::no_distance where nothing is
};

/// The drawers that make an image, beside the CPU's renderer.
enum class TargetUsers : std::uint8_t {
  cpu,
  ranks,             ///< also several ranks
  ranks_and_device,  ///< and a GPU
  device,            ///< also a GPU
};

template <class T>
struct TargetRow {
  std::string_view name;  ///< of Targets' member, as messages use it
  ImageView<T> Targets::*image;
  TargetKind kind;
  T empty;  ///< a pixel where nothing is, unless `kind` says another value
  TargetUsers users;
  std::string_view python;  ///< name in the Python package; empty: not there
  std::string_view file{};  ///< NAME of the program's `--image NAME=FILE`; empty: not there
  /// The same numbers in 32 bits, or null.
  ImageView<std::int32_t> Targets::*narrow = nullptr;

  [[nodiscard]] constexpr bool has_ranks() const {
    return users == TargetUsers::ranks || users == TargetUsers::ranks_and_device;
  }
  [[nodiscard]] constexpr bool has_device() const {
    return users == TargetUsers::device || users == TargetUsers::ranks_and_device;
  }
  /// Whether the host fills it: properties of the surface at a pixel, and numbers of 32 bits.
  [[nodiscard]] constexpr bool is_of_surface() const {
    return kind >= TargetKind::number || std::is_same_v<T, std::int32_t>;
  }
  [[nodiscard]] constexpr bool needs_scene() const { return kind >= TargetKind::surface; }
};

/// Targets::scalars where there is no number.
inline constexpr float kNoNumber = std::numeric_limits<float>::quiet_NaN();

/// Calls f(row) for each image.
template <class F>
constexpr void for_each_target(F&& f) {
  using enum TargetKind;
  using enum TargetUsers;
  using T = Targets;
  using I64 = TargetRow<std::int64_t>;
  using I32 = TargetRow<std::int32_t>;
  f(TargetRow<Rgba8>{"color8", &T::color8, color, {}, ranks_and_device, "color"});
  f(TargetRow<Vec4>{"color", &T::color, color, {}, ranks_and_device, "color_f32"});
  f(TargetRow<float>{"view_depth", &T::view_depth, distance, {}, ranks, "depth", "view-depth"});
  f(TargetRow<float>{"depth", &T::depth, key, 0, ranks_and_device, "depth_raw"});
  f(TargetRow<float>{"distance", &T::distance, distance, {}, ranks, "distance", "distance"});
  f(I64{"ids", &T::ids, key, -1, ranks_and_device, "id", {}, &T::ids32});
  f(I64{"instances", &T::instances, number, -1, ranks, "instance", "instances", &T::instances32});
  f(I64{"primitives", &T::primitives, number, -1, ranks, "face", "primitives", &T::primitives32});
  f(TargetRow<Vec2>{
      "barycentrics", &T::barycentrics, number, {}, ranks, "barycentrics", "barycentrics"});
  f(TargetRow<Vec3>{"normals", &T::normals, normal, {}, ranks, "normal", "normals"});
  f(TargetRow<Vec3>{
      "camera_normals", &T::camera_normals, normal, {}, ranks, "camera_normal", "camera-normals"});
  f(TargetRow<Vec3>{"positions", &T::positions, surface, {}, ranks, "position", "positions"});
  f(TargetRow<Vec4>{"albedo", &T::albedo, surface, {}, ranks, "albedo", "albedo"});
  f(TargetRow<Vec4>{"linear", &T::linear, color, {}, ranks, "linear", "linear"});
  f(TargetRow<float>{"scalars", &T::scalars, surface, kNoNumber, ranks, "scalars", "scalars"});
  f(I32{"ids32", &T::ids32, key, -1, cpu, {}});
  f(I32{"instances32", &T::instances32, number, -1, cpu, {}});
  f(I32{"primitives32", &T::primitives32, number, -1, cpu, {}});
  f(TargetRow<std::uint64_t>{"keys", &T::keys, key, 0, device, {}});
  f(TargetRow<std::uint32_t>{"overdraw", &T::overdraw, count, 0, cpu, {}});
  f(TargetRow<std::uint8_t>{"errors", &T::errors, count, 0, cpu, {}});
}

template <class T>
[[nodiscard]] constexpr T empty_pixel(const TargetRow<T>& row, float no_distance) {
  if constexpr (std::is_same_v<T, float>)
    if (row.kind == TargetKind::distance) return no_distance;
  return row.empty;
}

template <class Pred>
[[nodiscard]] bool has_target(const Targets& t, const Pred& pred) {
  bool any = false;
  for_each_target([&](const auto& row) { any = any || (!(t.*row.image).empty() && pred(row)); });
  return any;
}

/// The part `at` of a picture as a view in which pixels have the picture's places.
template <class T>
[[nodiscard]] ImageView<T> placed(const ImageView<T>& part, const Rect& at) {
  if (part.empty()) return part;
  return {part.data - at.y0 * part.stride - at.x0, at.x1, at.y1, part.stride};
}

[[nodiscard]] inline bool wants_surface(const Targets& t) {
  return has_target(t, [](const auto& row) { return row.is_of_surface(); });
}

}  // namespace rastrum::raster
