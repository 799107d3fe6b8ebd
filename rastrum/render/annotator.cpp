// SPDX-License-Identifier: BSD-3-Clause
// Annotations over a frame, for the program, Python and the window: needed images, order, default
// sizes.
#include <rastrum/annotate.hpp>

#include <algorithm>
#include <cstdint>
#include <mutex>
#include <utility>
#include <vector>

#include <rastrum/core/elementary.hpp>
#include <rastrum/core/float_scope.hpp>
#include <rastrum/core/no_memory.hpp>
#include <rastrum/core/reject.hpp>
#include <rastrum/fit.hpp>
#include <rastrum/parallel/device.hpp>
#include <rastrum/parallel/turn.hpp>
#include <rastrum/render/target_checks.hpp>

namespace rastrum {
namespace {

/// The image, or a new one if its size differs.
template <class T>
ImageView<T> sized(Image<T>& image, int width, int height) {
  if (image.width() != width || image.height() != height) image = Image<T>(width, height);
  return image.view();
}

}  // namespace

bool Annotations::any() const {
  return occlusion || dome || silhouettes || edges || bounds || axes || bar || !title.empty() ||
         !captions.empty();
}

void check(const Annotations& a) {
  if (a.captions.size() > 4) reject("Annotations::captions: there are four captions at most");
  if (!(a.text_scale > 0 && a.text_scale <= 100))
    reject("Annotations::text_scale must lie in 0 to 100, got ", a.text_scale);
}

Camera with_room(const Annotations& a, Camera camera, const SceneView& scene, int width,
                 int height) {
  const FloatScope floats;
  return with_room(a, std::move(camera), a.bounds ? bounds(scene) : Bounds{}, width, height);
}

Camera with_room(const Annotations& a, Camera camera, const Bounds& box, int width, int height) {
  const FloatScope floats;
  double room = a.bar ? 1.25 : 1;
  if (a.bounds && box.vertices_in_use != 0)
    room = overlay::room_for_bounds(camera, box.min, box.max, width, height);
  if (room == 1) return camera;
  camera.orthographic_height = static_cast<float>(camera.orthographic_height * room);
  const double half = room * elementary::tan(static_cast<double>(camera.fov_rad) / 2);
  camera.fov_rad = static_cast<float>(2 * elementary::atan(half));
  return camera;
}

overlay::Look look_of(const Annotations& a, Vec4 background) {
  overlay::Look look = overlay::look_on(background);
  look.scale = a.text_scale;
  return look;
}

void draw_words(const Annotations& a, const overlay::Canvas& canvas, const overlay::Look& look) {
  const FloatScope floats;
  using overlay::Corner;
  constexpr Corner kCorners[] = {Corner::bottom_right, Corner::top_left, Corner::top_right,
                                 Corner::bottom_left};
  check(a);
  if (!a.title.empty()) overlay::draw_title(canvas, a.title, look);
  for (std::size_t i = 0; i < a.captions.size(); ++i)
    overlay::draw_caption(canvas, a.captions[i], kCorners[i], look);
}

void draw_bar(const BarWords& words, const ScalarMapping& mapping, const ScalarColors& colors,
              const overlay::Canvas& canvas, const overlay::Look& look) {
  const FloatScope floats;
  overlay::ScalarBar bar = overlay::scalar_bar(mapping, colors);
  bar.title = words.title;
  bar.unit = words.unit;
  if (words.nan) bar.nan = mapping.nan;
  overlay::draw_scalar_bar(canvas, bar, look);
}

struct Annotator::Impl {
  std::mutex one_at_a_time;
  int threads;
  std::optional<Isa> isa;
  std::optional<Effects> effects;  ///< made when first needed
  Image<float> view_depth, depth, factor;
  Image<Vec3> normals;
  Image<std::int64_t> ids, instances;
  Image<float> solid_depth;  ///< of add_surface()
  Image<Vec3> solid_normals;
  Image<std::int64_t> solid_instances;
  std::optional<Surface> solid;        ///< of these, for one draw()
  ImageView<const float> edge_factor;  ///< of add_edges(), for one draw()

  void draw_effects(const Annotations& a, const SceneView& scene, const Camera& camera,
                    const Targets& targets, const overlay::Canvas& canvas, const SceneEdges* edges,
                    ImageView<const float> known_edges) {
    if (!a.occlusion && !a.dome && !a.silhouettes && !a.edges) return;
    if (!effects) effects.emplace(threads, isa);
    const int width = canvas.width(), height = canvas.height();
    const ImageView<float> to = sized(factor, width, height);
    const Surface surface =
        solid.value_or(Surface{targets.view_depth, targets.camera_normals, targets.instances});
    solid.reset();
    const auto darken = [&] { effects->darken(canvas.color8, canvas.color, to); };
    if (a.occlusion) {
      AmbientOcclusion o = *a.occlusion;
      if (o.radius == 0) o.radius = 0.15 * bounding_sphere(scene).radius;
      // Depth is enough, so the frame need not find normals.
      effects->occlude({.view_depth = surface.view_depth}, camera, o, canvas.color8, canvas.color);
    }
    if (a.dome) {
      EyeDome o = *a.dome;
      // The radius grows with the picture.
      if (o.radius_px == 0) o.radius_px = std::clamp(std::min(width, height) / 360, 1, 64);
      effects->eye_dome(surface, camera, o, to);
      darken();
    }
    if (a.silhouettes) {
      effects->silhouettes(surface, camera, *a.silhouettes, to);
      darken();
    }
    if (a.edges && !known_edges.empty()) {
      effects->darken(canvas.color8, canvas.color, known_edges);
    } else if (a.edges) {
      std::optional<SceneEdges> own;
      if (edges == nullptr) edges = &own.emplace(scene, a.edges->angle_degrees);
      effects->edges(targets.ids, *edges, camera, a.edges->width_px, to);
      darken();
    }
  }

  void add_targets(const Annotations& a, int width, int height, Targets& targets) {
    const auto add = [&](bool wanted, auto& target, auto& image) {
      if (wanted && target.empty()) target = sized(image, width, height);
    };
    add(a.occlusion || a.dome || a.silhouettes, targets.view_depth, view_depth);
    add(a.silhouettes.has_value(), targets.camera_normals, normals);
    add(a.silhouettes.has_value(), targets.instances, instances);
    add(a.edges.has_value(), targets.ids, ids);
    add(a.bounds, targets.depth, depth);
  }

  void add_surface(Renderer& renderer, const SceneView& scene, const Camera& camera,
                   const FrameOptions& frame, const Annotations& a, StopToken stop) {
    solid.reset();
    if (frame.transparency.method == Transparency::none ||
        !(a.occlusion || a.dome || a.silhouettes))
      return;
    const std::vector<Material> materials = materials_of_surface(scene);
    if (materials.empty()) return;
    SceneView cut = scene;
    cut.materials = materials;
    add_surface(a, frame.width, frame.height, [&](const Targets& targets) {
      renderer.render(cut, camera, with_infinity(frame), targets, {}, stop);
    });
  }

  void add_surface(const Annotations& a, int width, int height,
                   FunctionRef<void(const Targets&)> draw) {
    Targets targets{.view_depth = sized(solid_depth, width, height)};
    if (a.silhouettes) {
      targets.camera_normals = sized(solid_normals, width, height);
      targets.instances = sized(solid_instances, width, height);
    }
    draw(targets);
    solid = {targets.view_depth, targets.camera_normals, targets.instances};
  }

  void draw(const Annotations& a, const SceneView& scene, const Camera& camera, Vec4 background,
            const Targets& targets, const SceneEdges* edges) {
    // Taken even if this draw fails: the caller's image may be gone at the next one.
    const auto known_edges = std::exchange(edge_factor, {});
    check(a);
    if (!a.any()) return;
    const overlay::Canvas canvas{.color8 = targets.color8, .color = targets.color};
    check_annotated(targets);
    if (a.bar && scene.scalar_mappings.empty())
      reject("Annotations::bar: needs things with scalars; none has any");
    draw_effects(a, scene, camera, targets, canvas, edges, known_edges);
    const overlay::Look look = look_of(a, background);
    if (a.bounds)
      if (const Bounds box = bounds(scene); box.vertices_in_use != 0)
        overlay::draw_bounds(canvas, camera, box.min, box.max, targets.depth, look);
    if (a.axes) overlay::draw_axes(canvas, camera, overlay::Corner::bottom_left, look);
    if (a.bar) draw_bar(*a.bar, scene.scalar_mappings[0], scalar_colors(scene), canvas, look);
    draw_words(a, canvas, look);
  }
};

Annotator::Annotator(int threads, std::optional<Isa> isa)
    : impl_("Annotator", in_memory([] { return std::make_unique<Impl>(); })) {
  if (isa) static_cast<void>(choose_isa(isa));
  impl_->threads = threads;
  impl_->isa = isa;
}
Annotator::~Annotator() = default;
Annotator::Annotator(Annotator&&) noexcept = default;
Annotator& Annotator::operator=(Annotator&&) noexcept = default;

void Annotator::add_targets(const Annotations& a, int width, int height, Targets& targets) {
  parallel::in_turn(impl_->one_at_a_time, {},
                    [&] { impl_->add_targets(a, width, height, targets); });
}

void Annotator::add_surface(Renderer& renderer, const SceneView& scene, const Camera& camera,
                            const FrameOptions& frame, const Annotations& a, StopToken stop) {
  parallel::in_turn(impl_->one_at_a_time, stop,
                    [&] { impl_->add_surface(renderer, scene, camera, frame, a, stop); });
}

void Annotator::add_surface(const Annotations& a, int width, int height,
                            FunctionRef<void(const Targets&)> draw) {
  parallel::in_turn(impl_->one_at_a_time, {}, [&] { impl_->add_surface(a, width, height, draw); });
}

void Annotator::add_edges(ImageView<const float> factor) {
  parallel::in_turn(impl_->one_at_a_time, {}, [&] { impl_->edge_factor = factor; });
}

void Annotator::draw(const Annotations& a, const SceneView& scene, const Camera& camera,
                     Vec4 background, const Targets& targets, const SceneEdges* edges) {
  parallel::in_turn(impl_->one_at_a_time, {},
                    [&] { impl_->draw(a, scene, camera, background, targets, edges); });
}

FrameStats Annotator::render(Renderer& renderer, const SceneView& scene, const Camera& camera,
                             const FrameOptions& frame, const Annotations& a,
                             const Targets& targets, const SceneEdges* edges, StopToken stop) {
  return parallel::in_turn(impl_->one_at_a_time, stop, [&] {
    check(a);
    check_annotated(targets);
    Targets all = targets;
    impl_->add_targets(a, frame.width, frame.height, all);
    FrameStats stats = renderer.render(scene, camera, with_infinity(frame), all, {}, stop);
    impl_->add_surface(renderer, scene, camera, frame, a, stop);
    impl_->draw(a, scene, camera, frame.background, all, edges);
    set_no_distance(targets, frame.no_distance);
    return stats;
  });
}

}  // namespace rastrum
