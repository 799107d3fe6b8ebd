// SPDX-License-Identifier: BSD-3-Clause
#include "annotations.hpp"

#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <rastrum/annotate.hpp>

#include "scenes.hpp"

namespace rastrum::python {
namespace {

Annotations annotations(std::optional<double> occlusion_radius, double occlusion_strength,
                        std::optional<double> edl_strength, bool silhouettes,
                        std::optional<double> edge_angle, double edge_width, bool axes, bool bounds,
                        const std::optional<std::tuple<std::string, std::string, bool>>& bar,
                        const std::string& title, const std::vector<std::string>& captions,
                        double text_scale) {
  Annotations a;
  if (occlusion_radius)
    a.occlusion = AmbientOcclusion{.radius = *occlusion_radius, .strength = occlusion_strength};
  if (edl_strength) a.dome = EyeDome{.strength = *edl_strength, .radius_px = 0};
  if (silhouettes) a.silhouettes.emplace();
  if (edge_angle) a.edges = {*edge_angle, edge_width};
  a.axes = axes;
  a.bounds = bounds;
  if (bar) a.bar = {std::get<0>(*bar), std::get<1>(*bar), std::get<2>(*bar)};
  a.title = title;
  a.captions = captions;
  a.text_scale = text_scale;
  check(a);
  return a;
}

}  // namespace

void bind_annotations(nb::module_& m) {
  using nb::arg;
  nb::class_<Annotations>(m, "Annotations")
      .def(
          "with_room",
          [](const Annotations& a, const Camera& camera, const ArrayScene& scene, int width,
             int height) { return with_room(a, camera, scene.show().view, width, height); },
          arg("camera"), arg("scene"), arg("width"), arg("height"));
  m.def("annotations", annotations, arg("occlusion_radius").none(), arg("occlusion_strength"),
        arg("edl_strength").none(), arg("silhouettes"), arg("edge_angle").none(), arg("edge_width"),
        arg("axes"), arg("bounds"), arg("bar").none(), arg("title"), arg("captions"),
        arg("text_scale"));
}

}  // namespace rastrum::python
