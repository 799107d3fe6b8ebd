// Terrains as the command line names them: a height map with or without colours, a function, an
// expression.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include <rastrum/color_map.hpp>
#include <rastrum/io.hpp>
#include <rastrum/on_terrain.hpp>
#include <rastrum/terrain.hpp>
#include <rastrum/terrain_light.hpp>

namespace rastrum::cli {

/// Everything that a picture of a terrain depends on but terrain, light and camera.
struct TerrainLook : terrain::TerrainOptions, terrain::TerrainRendererOptions {};

struct TerrainInput {
  std::optional<std::filesystem::path> height, color;
  io::RawSize raw_size;                ///< size and byte order of raw heights
  std::optional<double> height_scale;  ///< none: the file's own, or one that suits its heights
  /// If the file does not give a unit, takes the original program's (1/257 of a cell for 16 bits,
  /// else a cell) instead of one that suits the heights.
  bool classic_scale = false;
  std::string function;  ///< a name or an expression, where there is no file
};

/// The tiling if none is given: `none` for files that end at their edge (io::ends_at_edge).
[[nodiscard]] terrain::Tiling suited_tiling(const TerrainInput& input);

/// Read once, lit as often as the sun moves.
class LoadedTerrain {
 public:
  /// Throws Error that names the file or the expression; UsageError unless there is one of a height
  /// file and a function, and colours only with a file.
  explicit LoadedTerrain(const TerrainInput& input);

  /// Colours by the heights as numbers, as the file has them, in the place of hypsometric ones.
  /// Requires that the input had no colours. Throws Error{invalid_argument} for what ScalarColors
  /// refuses.
  void show_numbers(const ScalarMapping& mapping, const TerrainLook& options);
  /// The colours of the numbers; null: they are not shown.
  [[nodiscard]] const ScalarColors* numbers() const { return numbers_ ? &*numbers_ : nullptr; }

  /// The terrain that is drawn. Without colours of its own it is coloured by height, and slopes are
  /// shaded.
  [[nodiscard]] terrain::Terrain lit(terrain::Light light, const TerrainLook& options) const;
  /// The same under these lights, of which each slope takes what it faces.
  [[nodiscard]] terrain::Terrain lit(const GroundLights& lights, const TerrainLook& options) const;

  [[nodiscard]] bool is_map() const { return !map_.heights.empty(); }
  [[nodiscard]] int width() const { return is_map() ? map_.heights.width() : 1024; }
  [[nodiscard]] int height() const { return is_map() ? map_.heights.height() : 1024; }
  /// The range of the heights, in cells; of functions as far as it is known.
  [[nodiscard]] double lowest() const { return low_; }
  [[nodiscard]] double highest() const { return high_; }
  /// How high one of the file's numbers is.
  [[nodiscard]] double cells_a_unit() const { return cells_a_unit_; }
  /// A line to show about the scale that was chosen because the file has none; empty: none was
  /// chosen.
  [[nodiscard]] const std::string& scale_note() const { return scale_note_; }

 private:
  terrain::HeightMap map_;
  terrain::HeightFunction function_;
  bool painted_ = false;  ///< the input has colours of its own
  std::optional<ScalarColors> numbers_;
  double low_ = 0, high_ = 0, cells_a_unit_ = 1;
  std::string scale_note_;
};

}  // namespace rastrum::cli
