// SPDX-License-Identifier: BSD-3-Clause
// Camera paths: keys in time, as JSON (docs/window.md has the format).
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
  /// Whether near_plane and far_plane count; else they follow the scene (place_planes).
  bool has_planes = false;
};

/// Eye, target and up follow curves; bounded values (field of view, height, planes) stay in the
/// range of neighbouring keys. The projection's kind is the first key's. All keys have planes or
/// none has.
using CameraPath = KeyedPath<PathKey>;

/// The members of a key that describe its camera; near and far with `planes`.
[[nodiscard]] nlohmann::ordered_json camera_json(const Camera& camera, bool planes);

/// `base`: for values that the first key leaves out; a later key takes them from the key before.
/// Throws Error{not_found, io, bad_format} naming the file and the key.
[[nodiscard]] CameraPath read_path(const std::filesystem::path& file, const Camera& base);
/// Floats keep their bits. Throws Error{io}.
void write_path(const std::filesystem::path& file, std::span<const PathKey> keys);

/// first + i / fps up to `last`, at least one. Throws Error{invalid_argument} beyond a million.
[[nodiscard]] std::vector<double> frame_times(double first_s, double last_s, double fps);

}  // namespace rastrum::cli
