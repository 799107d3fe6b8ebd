// SPDX-License-Identifier: BSD-3-Clause
// A terrain from a height map, a function or an expression, and under its light.
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

class LoadedTerrain {
 public:
  /// Throws Error that names the file or the expression; UsageError unless there is either a height
  /// file or a function, and colours only with a file.
  explicit LoadedTerrain(const TerrainInput& input);

  /// Colours the heights as numbers of the file, not by hypsometric hues. Requires an input without
  /// colours. Throws Error{invalid_argument} from ScalarColors.
  void show_numbers(const ScalarMapping& mapping, const TerrainLook& options);
  /// Null if numbers are not shown.
  [[nodiscard]] const ScalarColors* numbers() const { return numbers_ ? &*numbers_ : nullptr; }

  /// Without colours of its own it is coloured by height, and slopes are shaded.
  [[nodiscard]] terrain::Terrain lit(terrain::Light light, const TerrainLook& options) const;
  /// Under these lights; each slope takes what it faces.
  [[nodiscard]] terrain::Terrain lit(const GroundLights& lights, const TerrainLook& options) const;

  [[nodiscard]] bool is_map() const { return !map_.heights.empty(); }
  [[nodiscard]] int width() const { return is_map() ? map_.heights.width() : 1024; }
  [[nodiscard]] int height() const { return is_map() ? map_.heights.height() : 1024; }
  /// In cells; for functions as far as it is known.
  [[nodiscard]] double lowest() const { return low_; }
  [[nodiscard]] double highest() const { return high_; }
  /// The height of one unit of the file, in cells.
  [[nodiscard]] double cells_a_unit() const { return cells_a_unit_; }
  /// A line about the scale that was chosen because the file has none; else empty.
  [[nodiscard]] const std::string& scale_note() const { return scale_note_; }

 private:
  terrain::HeightMap map_;
  terrain::HeightFunction function_;
  bool painted_ = false;  ///< the input has colours
  std::optional<ScalarColors> numbers_;
  double low_ = 0, high_ = 0, cells_a_unit_ = 1;
  std::string scale_note_;
};

/// The defaults look from the south down on all of the map.
[[nodiscard]] terrain::TerrainCamera camera_of(const TerrainSceneArguments& a,
                                               const LoadedTerrain& source);

/// A terrain that is lit again when lights move with the camera.
class LitGround {
 public:
  /// Lit by the lights of `frame`, with the shadows of `light`; without any by `light`, a sun.
  /// `source` must outlive it. `camera` is the first one.
  LitGround(const LoadedTerrain& source, const TerrainLook& options, const terrain::Light& light,
            const FrameOptions& frame, const terrain::TerrainCamera& camera);

  [[nodiscard]] const terrain::Terrain& terrain() const { return lit_; }
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

/// Box, axes and bar as given, and the words `also`. A function has no ends, so no box.
[[nodiscard]] Annotations meant(const GroundOptions& ground, const LoadedTerrain& source,
                                Annotations also = {});
/// For numbers beside the picture.
[[nodiscard]] GroundNumbers numbers_of(const GroundOptions& ground, const LoadedTerrain& source);

}  // namespace rastrum::cli
