// SPDX-License-Identifier: BSD-3-Clause
// A frame and what is drawn over it, in one call: occlusion, eye-dome lighting, silhouettes, edges,
// a box with numbers, axes, a bar, words. effects.hpp and overlay.hpp describe each of these
// (docs/overlay.md, decision 0064).
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

/// Edges of the meshes, as black lines.
struct EdgeLines {
  double angle_degrees = 0;  ///< as SceneEdges
  double width_px = 1;       ///< (0, 64]
  bool operator==(const EdgeLines&) const = default;
};
/// A bar of SceneView::scalar_mappings[0], or of a terrain's heights.
struct BarWords {
  std::string title{}, unit{};
  bool nan = false;  ///< with a swatch of ScalarMapping::nan
};

/// Things drawn over a picture, in this order. Lengths that are not given follow the picture's
/// size.
struct Annotations {
  std::optional<AmbientOcclusion> occlusion{};  ///< radius 0: 0.15 of the scene's
  /// radius_px 0: by the picture's smaller side, 1/360 of it from 1 to 64.
  std::optional<EyeDome> dome{};
  std::optional<Silhouettes> silhouettes{};
  std::optional<EdgeLines> edges{};
  bool bounds = false;  ///< the box of the vertices in use
  bool axes = false;    ///< in the bottom left corner
  std::optional<BarWords> bar{};
  std::string title{};  ///< UTF-8, with \n between lines
  /// At most four: in the bottom right corner, the top left, the top right, the bottom left.
  std::vector<std::string> captions{};
  double text_scale = 1;  ///< of all words and lines of these, (0, 100]

  /// Whether anything is drawn.
  [[nodiscard]] bool any() const;
};

/// Throws Error{invalid_argument} for more than four captions and a text_scale out of range. The
/// options of effects are checked by these.
void check(const Annotations& annotations);

/// A camera that leaves a margin for the numbers of `bounds` (overlay::room_for_bounds), or for
/// `bar` (1.25 times as much is seen), around the scene that it was fitted to. As it is where
/// neither is drawn. O(vertices) for bounds.
[[nodiscard]] Camera with_room(const Annotations& annotations, Camera camera,
                               const SceneView& scene, int width, int height);

/// The same for a scene whose box is known.
[[nodiscard]] Camera with_room(const Annotations& annotations, Camera camera, const Bounds& box,
                               int width, int height);

/// The look of all words on a background: Annotations::text_scale, dark on a light ground.
[[nodiscard]] overlay::Look look_of(const Annotations& annotations, Vec4 background);
/// Title and captions alone, for pictures that are of no scene.
void draw_words(const Annotations& annotations, const overlay::Canvas& canvas,
                const overlay::Look& look);
/// overlay::scalar_bar of these numbers with these words, for numbers that are no scene's.
void draw_bar(const BarWords& words, const ScalarMapping& mapping, const ScalarColors& colors,
              const overlay::Canvas& canvas, const overlay::Look& look);

/// Draws over frames; keeps threads and the images that the drawing reads. Threads: calls of
/// render() take turns, as frames of a Renderer do; one thread must take all steps of a picture.
class Annotator {
 public:
  /// `threads` 0: all. Throws Error{no_device} for an instruction set that is not there.
  explicit Annotator(int threads = 0, std::optional<Isa> isa = {});
  ~Annotator();
  Annotator(Annotator&&) noexcept;
  Annotator& operator=(Annotator&&) noexcept;

  /// A frame by `renderer`, and `annotations` in its colours: Targets::color8, Targets::color or
  /// both; the other targets are as without. Images that the drawing needs and `targets` lack (view
  /// depth, camera normals, ids, depth) are drawn as well. `edges`: those of this scene by
  /// EdgeLines::angle_degrees, which saves finding them for each of many frames. The same bits for
  /// every number of threads and instruction set. Throws Error{invalid_argument} without colours,
  /// as check() and for a bar of a scene without numbers; else as Renderer::render.
  FrameStats render(Renderer& renderer, const SceneView& scene, const Camera& camera,
                    const FrameOptions& frame, const Annotations& annotations,
                    const Targets& targets, const SceneEdges* edges = nullptr, StopToken stop = {});

  /// The same in steps, for callers that draw the frame in another way (several passes, ranks).
  /// Adds to `targets` images of this object, which the next call may reuse.
  void add_targets(const Annotations& annotations, int width, int height, Targets& targets);
  /// Where textures blend, draws the surface that effects look at once more, as
  /// materials_of_surface() has it, for the draw() that follows; elsewhere nothing.
  void add_surface(Renderer& renderer, const SceneView& scene, const Camera& camera,
                   const FrameOptions& frame, const Annotations& annotations, StopToken stop = {});
  /// The same for callers that draw it themselves: `draw` fills the targets that it is given. They
  /// hold what materials_of_surface() has of the scene, and infinite distances where nothing is.
  void add_surface(const Annotations& annotations, int width, int height,
                   FunctionRef<void(const Targets&)> draw);
  /// For callers that find the edges themselves (ranks): factors as Effects::edges makes them,
  /// which the draw() that follows takes in place of its own. The image must live until then.
  void add_edges(ImageView<const float> factor);
  /// Into the colours of `targets`, which hold a frame with all that add_targets() added, drawn
  /// with an infinite FrameOptions::no_distance.
  void draw(const Annotations& annotations, const SceneView& scene, const Camera& camera,
            Vec4 background, const Targets& targets, const SceneEdges* edges = nullptr);

 private:
  struct RASTRUM_INSIDE Impl;
  Held<Owner<Impl>> impl_;
};

}  // namespace rastrum
