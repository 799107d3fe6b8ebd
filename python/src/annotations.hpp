// Words, axes and effects over a finished picture, in the same call as the frame.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <rastrum/effects.hpp>
#include <rastrum/frame.hpp>
#include <rastrum/overlay.hpp>
#include <rastrum/render.hpp>

#include "bindings.hpp"

namespace rastrum::python {

struct Annotations {
  std::optional<AmbientOcclusion> occlusion{};  ///< radius 0: 0.15 of the scene's
  std::optional<EyeDome> dome{};                ///< radius_px 0: by the picture's size
  std::optional<Silhouettes> silhouettes{};
  std::optional<double> edge_angle{};  ///< none: no edges
  double edge_width = 1;
  bool axes = false, bounds = false;
  struct Bar {
    std::string title, unit;
  };
  std::optional<Bar> bar{};  ///< of the scene's first mapping
  std::string title{};
  std::vector<std::string> captions{};
  double text_scale = 1;
};

/// Images that annotations look at and the frame's own targets lack, and who looks.
struct AnnotationScratch {
  Image<float> view_depth, depth, factor;
  Image<Vec3> normals;
  Image<std::int64_t> ids, instances;
  Image<float> solid_depth;  ///< where textures blend; see materials_of_surface
  Image<Vec3> solid_normals;
  Image<std::int64_t> solid_instances;
  std::optional<Effects> effects;

  /// Adds to `targets` what `a` looks at. Throws Error{invalid_argument} without colours.
  void attach(const Annotations& a, const FrameOptions& frame, Targets& targets);
  /// Into the colours of `targets`, as the frame left them. `edges`: of the scene, where there are
  /// any in `a`.
  void draw(const Annotations& a, const SceneEdges* edges, const SceneView& scene,
            const Camera& camera, const FrameOptions& frame, Renderer& renderer,
            const Targets& targets);

 private:
  [[nodiscard]] Surface surface_of(const Annotations& a, const SceneView& scene,
                                   const Camera& camera, const FrameOptions& frame,
                                   Renderer& renderer, const Targets& targets);
};

void bind_annotations(nb::module_& m);

}  // namespace rastrum::python
