// The command line of `rastrum render`.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "frame_images.hpp"
#include "output.hpp"
#include "scene_options.hpp"

namespace rastrum::cli {

enum class DepthUnit { reversed, world };

/// When a file is mapped and drawn in chunks (render_out_of_core.hpp).
enum class OutOfCore { automatic, always, never };

struct RenderArguments : SceneArguments {
  std::filesystem::path path;
  int turntable = 0;  ///< pictures of a full turn; 0: it does not turn
  std::optional<double> time_s;
  std::optional<int> animation;
  double fps = 30;
  bool fps_given = false;
  bool frames_given = false;
  bool prepares = false;  ///< meshes, before the first picture
  int frames = 1;
  bool quiet = false;
  std::optional<DepthUnit> depth_unit;
  std::optional<std::string> color_file;  ///< what -o says; with color_format it makes `color`
  std::optional<Format> color_format;
  Output color, depth, ids, objects, heatmap, errors, trace, stats;
  std::vector<FrameImage> images;
  bool hash = false;
  OutOfCore out_of_core = OutOfCore::automatic;
  double timeout_s = 0;  ///< of ranks that wait for each other; 0: for ever
  bool timeout_given = false;

  /// Whether one run draws many pictures.
  [[nodiscard]] bool is_sequence() const { return !path.empty() || turntable != 0; }
};

}  // namespace rastrum::cli
