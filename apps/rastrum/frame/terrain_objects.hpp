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

/// Where an object stands. Cells, and degrees as --angle has them.
struct Standing {
  double x = 0, y = 0;
  std::optional<double> height;  ///< of its lowest point; none: the ground's
  double scale = 1, turn_deg = 0;
};

struct TerrainObject {
  std::string text;   ///< as given, for messages
  std::string input;  ///< a file, or builtin:SHAPE
  bool is_sprite = false;
  std::optional<Standing> standing;  ///< none: a mesh whose coordinates are the terrain's
};

struct TerrainObjectArguments {
  std::vector<TerrainObject> objects;  ///< in command order
  SceneArguments scene;                ///< how they are drawn
};

/// Adds --mesh, --sprite and the options of how they are drawn; parsing fills `a`.
void add_terrain_objects(Parser app, TerrainObjectArguments& a);
/// Checks what the parser cannot see by itself. Throws UsageError.
void check_terrain_objects(const TerrainObjectArguments& a, const terrain::TerrainOptions& options);

/// Objects read from their files, then put on the ground, then drawn into pictures of the terrain.
class TerrainObjects {
 public:
  /// Requires an object. Throws Error naming the file.
  TerrainObjects(const TerrainObjectArguments& a, const TerrainLook& options, Timeline& timeline,
                 Progress& progress);

  /// Throws UsageError for what has no ground: beyond the map, or in a hole of it.
  void place(const terrain::Terrain& terrain);

  /// Draws them over `picture`, whose depth they need; adds to its statistics.
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
