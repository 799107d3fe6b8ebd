// SPDX-License-Identifier: BSD-3-Clause
// An Annotator renders a frame and draws over it in one call: ambient occlusion, eye-dome lighting,
// silhouettes, edges of meshes, a box with numbers, axes, a bar, a title and captions. effects.hpp
// and overlay.hpp describe each of these (docs/overlay.md, decision 0064).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <rastrum/color_map.hpp>
#include <rastrum/effects.hpp>
#include <rastrum/frame.hpp>
#include <rastrum/function.hpp>
#include <rastrum/held.hpp>
#include <rastrum/overlay.hpp>
#include <rastrum/render.hpp>
#include <rastrum/stop.hpp>

namespace RASTRUM_API rastrum {

/// The edges of the meshes, drawn as black lines.
struct EdgeLines {
  double angle_degrees = 0;  ///< the angle of SceneEdges, [0, 180]
  double width_px = 1;       ///< (0, 64]
  bool operator==(const EdgeLines&) const = default;
};
/// The words of a colour bar, for SceneView::scalar_mappings[0] or a terrain's heights.
struct BarWords {
  std::string title{}, unit{};
  bool nan = false;  ///< adds a swatch of the colour ScalarMapping::nan
};

/// These are drawn over a picture, in the order of the members. Letters and the lines of box and
/// axes follow the size of its smaller side.
struct Annotations {
  std::optional<AmbientOcclusion> occlusion{};  ///< radius 0: 0.15 of the scene's radius
  /// A radius_px of 0 stands for 1/360 of the picture's smaller side, but from 1 to 64.
  std::optional<EyeDome> dome{};
  std::optional<Silhouettes> silhouettes{};
  std::optional<EdgeLines> edges{};
  bool bounds = false;  ///< the bounding box of the vertices in use, with numbers
  bool axes = false;    ///< the directions of x, y and z, in the bottom left corner
  std::optional<BarWords> bar{};
  std::string title{};  ///< UTF-8, with \n between lines
  /// At most four, for the corners bottom right, top left, top right, bottom left, in turn.
  std::vector<std::string> captions{};
  double text_scale = 1;  ///< multiplies the size of letters, box, axes and bar, (0, 100]

  /// Whether anything is drawn.
  [[nodiscard]] bool any() const;
};

/// Throws Error{invalid_argument} for more than four captions and a text_scale out of range. The
/// options of the effects are checked when these are drawn.
void check(const Annotations& annotations);

/// Widens the view of `camera`, which was fitted to `scene`: to make room for the numbers of
/// Annotations::bounds (overlay::room_for_bounds) or, without these, for the bar (1.25 times as
/// much is seen). Without both the camera stays as it is. Cost: O(vertices) for bounds.
[[nodiscard]] Camera with_room(const Annotations& annotations, Camera camera,
                               const SceneView& scene, int width, int height);

/// Does the same for a scene whose bounding box is known.
[[nodiscard]] Camera with_room(const Annotations& annotations, Camera camera, const Bounds& box,
                               int width, int height);

/// The look of words and lines, dark on a light background, scaled by Annotations::text_scale.
[[nodiscard]] overlay::Look look_of(const Annotations& annotations, Vec4 background);
/// Draws the title and the captions alone, for pictures that show no scene.
void draw_words(const Annotations& annotations, const overlay::Canvas& canvas,
                const overlay::Look& look);
/// Draws overlay::scalar_bar of `mapping` and `colors` with `words`, for numbers of no scene.
void draw_bar(const BarWords& words, const ScalarMapping& mapping, const ScalarColors& colors,
              const overlay::Canvas& canvas, const overlay::Look& look);

/// Renders frames and draws annotations over them; keeps threads and the images that the effects
/// read. Several threads may call render(), and take turns as frames of a Renderer do. All steps of
/// one picture (below) must be called from one thread.
class Annotator {
 public:
  /// `threads` 0: all of the machine. Throws Error{no_device} for an instruction set that it lacks.
  explicit Annotator(int threads = 0, std::optional<Isa> isa = {});
  ~Annotator();
  Annotator(Annotator&&) noexcept;
  Annotator& operator=(Annotator&&) noexcept;

  /// Renders a frame by `renderer` and draws `annotations` into its colours: Targets::color8,
  /// Targets::color or both. The other targets stay as they are without annotations. Images that
  /// the drawing needs and `targets` lack (view depth, camera normals, ids, depth) are rendered as
  /// well. `edges`: the edges of this scene for EdgeLines::angle_degrees, so that many frames need
  /// not find them again. The bits are the same for every number of threads and instruction set.
  /// Throws Error{invalid_argument} without colours, for a bar of a scene without scalars, and as
  /// check(); else as Renderer::render.
  FrameStats render(Renderer& renderer, const SceneView& scene, const Camera& camera,
                    const FrameOptions& frame, const Annotations& annotations,
                    const Targets& targets, const SceneEdges* edges = nullptr, StopToken stop = {});

  /// This and the functions below do the same in steps, for callers that draw the frame in another
  /// way (several passes, ranks). It adds to `targets` the images that the annotations need, which
  /// are this object's; the next call may reuse them.
  void add_targets(const Annotations& annotations, int width, int height, Targets& targets);
  /// Where textures blend, renders once more the surface that the effects of the next draw() look
  /// at, with materials_of_surface(). Does nothing for other scenes.
  void add_surface(Renderer& renderer, const SceneView& scene, const Camera& camera,
                   const FrameOptions& frame, const Annotations& annotations, StopToken stop = {});
  /// Does the same for callers that render that surface themselves: `draw` fills the targets that
  /// it is given by a frame with materials_of_surface() and an infinite FrameOptions::no_distance.
  void add_surface(const Annotations& annotations, int width, int height,
                   FunctionRef<void(const Targets&)> draw);
  /// For callers that find the edges themselves (ranks): the next draw() takes `factor`, an image
  /// as Effects::edges makes it, in place of its own. The image must live until then.
  void add_edges(ImageView<const float> factor);
  /// Draws the annotations into the colours of `targets`, which hold a frame with all that
  /// add_targets() added, rendered with an infinite FrameOptions::no_distance.
  void draw(const Annotations& annotations, const SceneView& scene, const Camera& camera,
            Vec4 background, const Targets& targets, const SceneEdges* edges = nullptr);

 private:
  struct RASTRUM_INSIDE Impl;
  Held<Owner<Impl>> impl_;
};

}  // namespace rastrum
