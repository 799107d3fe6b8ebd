// SPDX-License-Identifier: BSD-3-Clause
// Camera paths over a terrain: camera_path.hpp with a terrain's numbers in the keys.
#pragma once

#include <filesystem>
#include <span>

#include <rastrum/terrain.hpp>

#include "key_curve.hpp"

namespace rastrum::cli {

struct TerrainPathKey {
  double time_s = 0;
  terrain::TerrainCamera camera;
};

using TerrainPath = KeyedPath<TerrainPathKey>;

/// `base`: for values that the first key leaves out; a later key takes them from the key before.
/// Throws Error{not_found, io, bad_format} naming the file and the key.
[[nodiscard]] TerrainPath read_path(const std::filesystem::path& file,
                                    const terrain::TerrainCamera& base);
/// Keeps all bits: writes angles in radians. Throws Error{io}.
void write_path(const std::filesystem::path& file, std::span<const TerrainPathKey> keys);

}  // namespace rastrum::cli
