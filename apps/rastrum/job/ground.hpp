// SPDX-License-Identifier: BSD-3-Clause
// A terrain as it is read (a height map with or without colours, a function, an expression), and in
// its light, for the program's pictures and the window's.
#pragma once

#include <optional>
#include <string>

#include <rastrum/color_map.hpp>
#include <rastrum/frame.hpp>
#include <rastrum/on_terrain.hpp>
#include <rastrum/terrain.hpp>
#include <rastrum/terrain_light.hpp>

#include "parse/ground_options.hpp"
#include "parse/terrain_options.hpp"

namespace rastrum::cli {

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

/// The camera, with defaults for what was not given: over the south of the map, looking down on all
/// of it.
[[nodiscard]] terrain::TerrainCamera camera_of(const TerrainSceneArguments& a,
                                               const LoadedTerrain& source);

/// A terrain that is lit again where lights move with the camera.
class LitGround {
 public:
  /// By the lights of `frame`, with the shadows of `light`; without any by `light`, a sun. `source`
  /// must outlive it. `camera`: who looks first.
  LitGround(const LoadedTerrain& source, const TerrainLook& options, const terrain::Light& light,
            const FrameOptions& frame, const terrain::TerrainCamera& camera);

  [[nodiscard]] const terrain::Terrain& terrain() const { return lit_; }
  /// As `camera` sees it.
  const terrain::Terrain& seen_from(const terrain::TerrainCamera& camera);

 private:
  const GroundLights& at(const terrain::TerrainCamera& camera) {
    lights_.camera = camera;
    return lights_;
  }

  const LoadedTerrain& source_;
  TerrainLook options_;
  bool moves_;
  GroundLights lights_;
  terrain::Terrain lit_;
};

/// The annotations of a picture of this terrain: box, axes and bar as they were given, and the
/// words `also`. A function has no ends, so no box.
[[nodiscard]] Annotations meant(const GroundOptions& ground, const LoadedTerrain& source,
                                Annotations also = {});
/// The meaning of its heights, for numbers beside the picture.
[[nodiscard]] GroundNumbers numbers_of(const GroundOptions& ground, const LoadedTerrain& source);

}  // namespace rastrum::cli
