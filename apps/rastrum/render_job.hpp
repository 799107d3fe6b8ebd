// The frames of `rastrum render`: which images are filled when, and what is timed.
#pragma once

#include <vector>

#include <rastrum/annotate.hpp>
#include <rastrum/render.hpp>

#include "frame_images.hpp"

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

struct Pictures {
  Image<Rgba8> color8;
  Image<Vec4> color;
  Image<float> depth;
  Image<std::int64_t> ids;
  Image<std::uint32_t> overdraw;
  Image<std::uint8_t> errors;
  std::vector<FrameImagePixels> images;  ///< as Wanted's
  Targets targets;                       ///< all of these, and what Wanted::annotator added
};

/// Allocates what is wanted and returns the views.
[[nodiscard]] Targets make_targets(const Wanted& wanted, const FrameOptions& options,
                                   Pictures& pictures);

/// `frame_ms` and the stages are of the whole call, from the caller's mesh in memory to the
/// finished image: what the façade does before the rasterizer's own clock is the stage "prepare".
[[nodiscard]] FrameStats timed_render(Renderer& renderer, const SceneView& scene,
                                      const Camera& camera, const FrameOptions& frame,
                                      const Targets& targets, Timeline& timeline,
                                      const std::string& label);

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
