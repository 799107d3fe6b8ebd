// Camera paths over a terrain: the files of camera_path.hpp with a terrain's numbers in their keys.
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include <rastrum/terrain.hpp>

#include "key_curve.hpp"

namespace rastrum::cli {

struct TerrainPathKey {
  double time_s = 0;
  terrain::TerrainCamera camera;
};

class TerrainPath {
 public:
  /// Requires at least one key, times increasing.
  TerrainPath(std::vector<TerrainPathKey> keys, Interpolation interpolation);

  [[nodiscard]] double first_s() const { return keys_.front().time_s; }
  [[nodiscard]] double last_s() const { return keys_.back().time_s; }
  /// At a key's time exactly its camera; before the first and after the last those.
  [[nodiscard]] terrain::TerrainCamera at(double time_s) const;

 private:
  std::vector<TerrainPathKey> keys_;
  std::vector<KeyCurve> curves_;
};

/// `base`: what the first key leaves out; a later key takes it from the key before.
/// Throws Error{not_found, io, bad_format} naming the file and the key.
[[nodiscard]] TerrainPath read_terrain_path(const std::filesystem::path& file,
                                            const terrain::TerrainCamera& base);
/// Keeps all bits: angles are written in radians. Throws Error{io}.
void write_terrain_path(const std::filesystem::path& file, std::span<const TerrainPathKey> keys);

}  // namespace rastrum::cli
