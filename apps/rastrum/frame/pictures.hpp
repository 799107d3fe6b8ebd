// SPDX-License-Identifier: BSD-3-Clause
// Pictures of meshes: which images are filled when, and what is timed.
#pragma once

#include <vector>

#include <rastrum/annotate.hpp>
#include <rastrum/render.hpp>

#include "parse/render_arguments.hpp"

namespace rastrum::cli {

class Progress;
class Timeline;

/// The images that outputs ask for.
struct Wanted {
  bool color8 = false, color = false, depth = false, ids = false, overdraw = false, errors = false;
  std::vector<std::string_view> images{};
  const Annotations* notes = nullptr;  ///< what is drawn over it, by `annotator`, looks at more
  Annotator* annotator = nullptr;      ///< with `notes`
};

[[nodiscard]] Wanted wanted_of(const RenderArguments& a, const Annotations* notes = nullptr,
                               Annotator* annotator = nullptr);

/// How many rows of the picture are drawn and written at once, so that what is held of it stays
/// within `bytes`; 0: all. Images that look at a whole picture are not asked about here.
[[nodiscard]] int rows_at_once(const RenderArguments& a, std::uint64_t bytes);
/// The options that need a whole picture, as the begin of "… a whole picture"; null: none, so that
/// it can be drawn in bands.
[[nodiscard]] const char* why_whole(const RenderArguments& a, const Annotations& notes);

struct Pictures {
  Image<Rgba8> color8;
  Image<Vec4> color;
  Image<float> depth;
  Image<std::int64_t> ids;
  Image<std::uint32_t> overdraw;
  Image<std::uint8_t> errors;
  std::vector<FrameImagePixels> images;  ///< as Wanted's
  Targets targets;                       ///< all of these, and what Wanted::annotator added
  Camera camera;                         ///< from where
};

[[nodiscard]] Targets make_targets(const Wanted& wanted, Size size, Pictures& pictures);

/// Words and effects, into the colours alone.
void annotate(const Pictures& pictures, const Annotations& notes, const SceneView& scene,
              const FrameOptions& frame, Annotator& annotator);

/// Renders into `pictures` and returns the statistics of each timed frame.
/// `timed`: `frames` frames fill the 8-bit image alone, whatever the outputs are, so that times
/// can be compared; then one more pass, untimed, fills the other images if any is wanted.
/// Otherwise one pass fills everything that is wanted.
[[nodiscard]] std::vector<FrameStats> render_frames(Renderer& renderer, const SceneView& scene,
                                                    const Camera& camera, const FrameOptions& frame,
                                                    Wanted wanted, bool timed, int frames,
                                                    Pictures& pictures, Timeline& timeline,
                                                    Progress& progress);

}  // namespace rastrum::cli
