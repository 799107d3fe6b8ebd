// SPDX-License-Identifier: BSD-3-Clause
// Meshes and sprites that stand on the terrain: `--mesh INPUT[@x=…]`, `--sprite FILE@x=…`.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <apps/command_line/parser.hpp>

#include <rastrum/on_terrain.hpp>
#include <rastrum/terrain.hpp>

#include "job/ground.hpp"
#include "parse/scene_options.hpp"

namespace rastrum::cli {

class Progress;
class Timeline;

/// In cells; degrees as for --angle.
struct Standing {
  double x = 0, y = 0;
  std::optional<double> height;  ///< of its lowest point; none: on the ground
  double scale = 1, turn_deg = 0;
};

struct TerrainObject {
  std::string text;   ///< as given, for messages
  std::string input;  ///< a file, or builtin:SHAPE
  bool is_sprite = false;
  std::optional<Standing> standing;  ///< none: the mesh has the terrain's coordinates
};

struct TerrainObjectArguments {
  std::vector<TerrainObject> objects;  ///< in command order
  SceneArguments scene;                ///< how they are drawn
};

/// Parsing fills `a`.
void add_terrain_objects(Parser app, TerrainObjectArguments& a);
/// Checks what the parser cannot check. Throws UsageError.
void check_terrain_objects(const TerrainObjectArguments& a, const terrain::TerrainOptions& options);

/// Objects that are read from files, put on the ground, and drawn into pictures of the terrain.
class TerrainObjects {
 public:
  /// Requires an object. Throws Error naming the file.
  TerrainObjects(const TerrainObjectArguments& a, const TerrainLook& options, Timeline& timeline,
                 Progress& progress);

  /// Throws UsageError for an object beyond the map or in a hole of it.
  void place(const terrain::Terrain& terrain);

  /// Draws them over `picture`, which needs depth; adds to its statistics.
  void draw(const terrain::TerrainTargets& picture, terrain::TerrainStats& stats);

  [[nodiscard]] const std::vector<std::string>& warnings() const { return scene_.warnings; }
  [[nodiscard]] std::uint64_t triangles() const { return scene_.triangle_count(); }

 private:
  struct Part {
    TerrainObject object;
    std::size_t first, last;  ///< its instances
  };
  terrain::TerrainOptions options_;
  Scene scene_;
  std::vector<Part> parts_;
  std::vector<std::size_t> facing_;
  std::optional<SceneBinding> binding_;
  FrameOptions frame_;
  std::optional<SceneOnTerrain> painter_;
};

}  // namespace rastrum::cli
