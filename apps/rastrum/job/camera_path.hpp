// SPDX-License-Identifier: BSD-3-Clause
// Camera paths: keys in time, read from JSON and written to it (docs/window.md has the format).
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include <rastrum/camera.hpp>

#include "key_curve.hpp"

namespace rastrum::cli {

struct PathKey {
  double time_s = 0;
  Camera camera;
  /// Whether near_plane and far_plane are meant; else they follow the scene (place_planes).
  bool has_planes = false;
};

/// Eye, target and up go through the keys on curves, what has bounds (field of view, height,
/// planes) without leaving the range of neighbouring keys; the projection's kind is the first
/// key's. Planes are in all keys or in none.
using CameraPath = KeyedPath<PathKey>;

/// The members of a key that describe its camera; with `planes` near and far, too.
[[nodiscard]] nlohmann::ordered_json camera_json(const Camera& camera, bool planes);

/// `base`: what the first key leaves out; a later key takes it from the key before.
/// Throws Error{not_found, io, bad_format} naming the file and the key.
[[nodiscard]] CameraPath read_path(const std::filesystem::path& file, const Camera& base);
/// Floats keep their bits. Throws Error{io}.
void write_path(const std::filesystem::path& file, std::span<const PathKey> keys);

/// The times of the pictures of a path: first + i / fps up to `last`, at least one.
/// Throws Error{invalid_argument} beyond a million.
[[nodiscard]] std::vector<double> frame_times(double first_s, double last_s, double fps);

}  // namespace rastrum::cli
