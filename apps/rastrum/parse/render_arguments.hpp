// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "frame_images.hpp"
#include "output.hpp"
#include "scene_options.hpp"

namespace rastrum::cli {

enum class DepthUnit { reversed, world };

/// When a file is mapped and drawn in chunks (job/large_job.hpp).
enum class OutOfCore { automatic, always, never };

struct PictureOutputs {
  Output color, depth, ids, objects, heatmap, errors;
  std::vector<FrameImage> images;

  [[nodiscard]] std::vector<const Output*> asked_for() const;
  /// For picture `number` of `count`; throws as numbered(Output).
  [[nodiscard]] PictureOutputs numbered(std::size_t number, std::size_t count) const;
};

struct RenderArguments : SceneArguments, RunOptions {
  int turntable = 0;  ///< pictures of a full turn; 0: none
  std::optional<double> time_s;
  std::optional<int> animation;
  bool prepares = false;  ///< prepares meshes before the first picture
  std::optional<DepthUnit> depth_unit;
  std::optional<std::string> color_file;  ///< the text of -o; with color_format it makes the output
  std::optional<Format> color_format;
  PictureOutputs outputs;
  Output trace;
  OutOfCore out_of_core = OutOfCore::automatic;
  std::optional<double> timeout_s;  ///< of ranks that wait for each other; none: for ever

  [[nodiscard]] bool is_sequence() const { return !path.empty() || turntable != 0; }
  [[nodiscard]] bool has_colors() const { return outputs.color || outputs.errors || hash; }
  /// Whether --hash is of the 8-bit colours because no picture is written.
  [[nodiscard]] bool hashes_alone() const { return hash && outputs.asked_for().empty(); }
};

/// Parsing fills `a`, which must outlive `app`.
void add_render_options(Parser app, RenderArguments& a);
/// Resolves options that depend on each other, and throws UsageError for what the parser cannot
/// check. Call it once all options are read.
void settle(RenderArguments& a);
/// Throws if outputs cannot be written. Called again once the inputs have named their files.
void check_files(const RenderArguments& a);

}  // namespace rastrum::cli
