#include "annotations.hpp"

#include <algorithm>

#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <rastrum/scene.hpp>

#include "scenes.hpp"

namespace rastrum::python {
namespace {

template <class T>
ImageView<T> own(Image<T>& image, const FrameOptions& frame) {
  if (image.width() != frame.width || image.height() != frame.height)
    image = Image<T>(frame.width, frame.height);
  return image.view();
}

/// As --fit sphere has it, whose picture it fills.
double radius_of(const SceneView& scene) {
  return static_cast<double>(fit_camera(scene, 1, true).orthographic_height) / 2;
}

Annotations annotations(std::optional<double> occlusion_radius, double occlusion_strength,
                        std::optional<double> edl_strength, bool silhouettes,
                        std::optional<double> edge_angle, double edge_width, bool axes, bool bounds,
                        const std::optional<std::pair<std::string, std::string>>& bar,
                        const std::string& title, const std::vector<std::string>& captions,
                        double text_scale) {
  Annotations a;
  if (occlusion_radius)
    a.occlusion = AmbientOcclusion{.radius = *occlusion_radius, .strength = occlusion_strength};
  if (edl_strength) a.dome = EyeDome{.strength = *edl_strength, .radius_px = 0};
  if (silhouettes) a.silhouettes.emplace();
  a.edge_angle = edge_angle;
  a.edge_width = edge_width;
  a.axes = axes;
  a.bounds = bounds;
  if (bar) a.bar = {bar->first, bar->second};
  a.title = title;
  a.captions = captions;
  a.text_scale = text_scale;
  if (captions.size() > 4)
    throw Error(Errc::invalid_argument, "annotate: there are four captions at most");
  if (!(text_scale > 0 && text_scale <= 100))
    throw Error(Errc::invalid_argument, "annotate: text_scale must lie in 0 to 100");
  return a;
}

}  // namespace

void AnnotationScratch::attach(const Annotations& a, const FrameOptions& frame, Targets& targets) {
  if (targets.color8.empty() && targets.color.empty())
    throw Error(Errc::invalid_argument,
                "annotate: is drawn into color or color_f32; ask for it by outputs");
  const auto add = [&](bool wanted, auto& target, auto& image) {
    if (wanted && target.empty()) target = own(image, frame);
  };
  add(a.occlusion || a.dome || a.silhouettes, targets.view_depth, view_depth);
  add(a.silhouettes.has_value(), targets.camera_normals, normals);
  add(a.silhouettes.has_value(), targets.instances, instances);
  add(a.edge_angle.has_value(), targets.ids, ids);
  add(a.bounds, targets.depth, depth);
}

Surface AnnotationScratch::surface_of(const Annotations& a, const SceneView& scene,
                                      const Camera& camera, const FrameOptions& frame,
                                      Renderer& renderer, const Targets& targets) {
  const Surface frames_own{targets.view_depth, targets.camera_normals, targets.instances};
  if (frame.transparency.method == Transparency::none || !(a.occlusion || a.dome || a.silhouettes))
    return frames_own;
  const std::vector<Material> materials = materials_of_surface(scene);
  if (materials.empty()) return frames_own;
  SceneView solid = scene;
  solid.materials = materials;
  Targets again{.view_depth = own(solid_depth, frame)};
  if (a.silhouettes) {
    again.camera_normals = own(solid_normals, frame);
    again.instances = own(solid_instances, frame);
  }
  renderer.render(solid, camera, frame, again);
  return {again.view_depth, again.camera_normals, again.instances};
}

void AnnotationScratch::draw(const Annotations& a, const SceneEdges* edges, const SceneView& scene,
                             const Camera& camera, const FrameOptions& frame, Renderer& renderer,
                             const Targets& targets) {
  if (!effects) effects.emplace(renderer.options().threads, renderer.options().isa);
  const ImageView<float> to = own(factor, frame);
  const Surface surface = surface_of(a, scene, camera, frame, renderer, targets);
  const auto darken = [&] { effects->darken(targets.color8, targets.color, to); };
  if (a.occlusion) {
    AmbientOcclusion o = *a.occlusion;
    if (o.radius == 0) o.radius = 0.15 * radius_of(scene);
    // By depth alone, as the program does.
    effects->ambient_occlusion({.view_depth = surface.view_depth}, camera, o, to);
    darken();
  }
  if (a.dome) {
    EyeDome o = *a.dome;
    if (o.radius_px == 0)
      o.radius_px = std::clamp(std::min(frame.width, frame.height) / 360, 1, 64);
    effects->eye_dome(surface, camera, o, to);
    darken();
  }
  if (a.silhouettes) {
    effects->silhouettes(surface, camera, *a.silhouettes, to);
    darken();
  }
  if (edges != nullptr) {
    effects->edges(targets.ids, *edges, camera, a.edge_width, to);
    darken();
  }
  const overlay::Canvas canvas{.color8 = targets.color8, .color = targets.color};
  overlay::Look look = overlay::look_on(frame.background);
  look.scale = a.text_scale;
  if (a.bounds)
    if (const Bounds box = bounds(scene); box.vertices_in_use != 0)
      overlay::draw_bounds(canvas, camera, box.min, box.max, targets.depth, look);
  if (a.axes) overlay::draw_axes(canvas, camera, overlay::Corner::bottom_left, look);
  if (a.bar) {
    if (scene.scalar_mappings.empty())
      throw Error(Errc::invalid_argument, "annotate: bar is of things with scalars; none has any");
    overlay::ScalarBar bar = overlay::scalar_bar(scene.scalar_mappings[0], scalar_colors(scene));
    bar.title = a.bar->title;
    bar.unit = a.bar->unit;
    overlay::draw_scalar_bar(canvas, bar, look);
  }
  using overlay::Corner;
  constexpr Corner kCorners[] = {Corner::bottom_right, Corner::top_left, Corner::top_right,
                                 Corner::bottom_left};
  if (!a.title.empty()) overlay::draw_title(canvas, a.title, look);
  for (std::size_t i = 0; i < a.captions.size(); ++i)
    overlay::draw_caption(canvas, a.captions[i], kCorners[i], look);
}

void bind_annotations(nb::module_& m) {
  using nb::arg;
  nb::class_<Annotations>(m, "Annotations")
      .def(
          "room",
          [](const Annotations& a, const Camera& camera, const ArrayScene& scene, int width,
             int height) {
            const Bounds box = a.bounds ? bounds(scene.view()) : Bounds{};
            return box.vertices_in_use != 0
                       ? overlay::room_for_bounds(camera, box.min, box.max, width, height)
                   : a.bar ? 1.25
                           : 1.0;
          },
          arg("camera"), arg("scene"), arg("width"), arg("height"));
  m.def("annotations", annotations, arg("occlusion_radius").none(), arg("occlusion_strength"),
        arg("edl_strength").none(), arg("silhouettes"), arg("edge_angle").none(), arg("edge_width"),
        arg("axes"), arg("bounds"), arg("bar").none(), arg("title"), arg("captions"),
        arg("text_scale"));
}

}  // namespace rastrum::python
