// SPDX-License-Identifier: BSD-3-Clause
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
  const Annotations* notes = nullptr;  ///< drawn over it by `annotator`; may need more images
  Annotator* annotator = nullptr;      ///< with `notes`
};

[[nodiscard]] Wanted wanted_of(const RenderArguments& a, const Annotations* notes = nullptr,
                               Annotator* annotator = nullptr);

/// Rows that are drawn and written at once to hold at most `bytes` of the picture; 0: all. Ignores
/// images that need a whole picture.
[[nodiscard]] int rows_at_once(const RenderArguments& a, std::uint64_t bytes);
/// The options that need a whole picture, as the begin of "… a whole picture"; null: none.
[[nodiscard]] const char* why_whole(const RenderArguments& a, const Annotations& notes);

struct Pictures {
  Image<Rgba8> color8;
  Image<Vec4> color;
  Image<float> depth;
  Image<std::int64_t> ids;
  Image<std::uint32_t> overdraw;
  Image<std::uint8_t> errors;
  std::vector<FrameImagePixels> images;  ///< as in Wanted
  Targets targets;                       ///< all of these, and those of Wanted::annotator
  Camera camera;                         ///< from where
};

[[nodiscard]] Targets make_targets(const Wanted& wanted, Size size, Pictures& pictures);

/// Words and effects, into the colours alone.
void annotate(const Pictures& pictures, const Annotations& notes, const SceneView& scene,
              const FrameOptions& frame, Annotator& annotator);

/// Renders into `pictures` and returns the statistics of each timed frame. `timed`: `frames` frames
/// fill only the 8-bit image, whatever the outputs are, so that times can be compared; one more,
/// untimed pass fills the other wanted images. Otherwise one pass fills everything.
[[nodiscard]] std::vector<FrameStats> render_frames(Renderer& renderer, const SceneView& scene,
                                                    const Camera& camera, const FrameOptions& frame,
                                                    Wanted wanted, bool timed, int frames,
                                                    Pictures& pictures, Timeline& timeline,
                                                    Progress& progress);

}  // namespace rastrum::cli
