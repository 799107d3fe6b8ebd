// The frames of `rastrum render`: which images are filled when, and what is timed.
#pragma once

#include <vector>

#include <rastrum/effects.hpp>
#include <rastrum/render.hpp>

#include "frame_images.hpp"

namespace rastrum::cli {

class Progress;
class Timeline;

/// The images that outputs ask for.
struct Wanted {
  bool color8 = false, color = false, depth = false, ids = false, overdraw = false, errors = false;
  std::vector<const FrameImageKind*> images{};
  bool surface = false;  ///< the depth that effects look at
  bool edges = false;    ///< normals and instances beside it
};

struct Pictures {
  Image<Rgba8> color8;
  Image<Vec4> color;
  Image<float> depth;
  Image<std::int64_t> ids;
  Image<std::uint32_t> overdraw;
  Image<std::uint8_t> errors;
  std::vector<FrameImagePixels> images;  ///< as Wanted's
  Image<float> view_depth;               ///< of these what is no image of Wanted's
  Image<Vec3> camera_normals;
  Image<std::int64_t> instances;
  Surface surface;           ///< with Wanted::surface; of this object's images, or of its frame's
  Image<float> solid_depth;  ///< where textures blend; see materials_of_surface
  Image<Vec3> solid_normals;
  Image<std::int64_t> solid_instances;
};

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
