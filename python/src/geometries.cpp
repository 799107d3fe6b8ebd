// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>

#include <rastrum/mesh.hpp>
#include <rastrum/points_and_lines.hpp>
#include <rastrum/surfaces.hpp>

#include "bindings.hpp"

namespace rastrum::python {
namespace {

using Maybe = std::optional<Array>;

Per per_of(const std::string& name) {
  if (name == "vertex") return Per::vertex;
  if (name == "corner") return Per::corner;
  if (name == "face") return Per::face;
  if (name == "mesh") return Per::mesh;
  throw Error(Errc::invalid_argument, "per: " + name + " must be vertex, corner, face or mesh");
}

/// Keeps the arrays alive that it views.
struct Maker {
  ArrayGeometry made{};

  template <ViewedValue T>
  [[nodiscard]] ArrayView<T> take(const Array& array, const char* name) {
    made.kept.push_back(array);
    return values<T>(array, name);
  }
  template <ViewedValue T>
  [[nodiscard]] ArrayView<T> take(const Maybe& array, const char* name) {
    return array ? take<T>(*array, name) : ArrayView<T>{};
  }
  [[nodiscard]] ScalarView take_scalars(const Maybe& array) {
    if (!array) return {};
    made.kept.push_back(*array);
    return scalars(*array, "scalars");
  }
  [[nodiscard]] IndexView take_indices(const Maybe& array, const char* name) {
    if (!array) return {};
    made.kept.push_back(*array);
    return indices(*array, name);
  }
  template <class View>
  ArrayGeometry finish(View view, const Maybe& colors, const Maybe& scalars) {
    view.colors = take<Vec4>(colors, "colors");
    view.scalars = take_scalars(scalars);
    return finish(view);
  }
  template <class View>
  ArrayGeometry finish(View view, const Maybe& radii, float radius, const Maybe& colors,
                       const Maybe& scalars) {
    view.radii = take<float>(radii, "radii");
    view.radius = radius;
    return finish(view, colors, scalars);
  }
  template <class View>
  ArrayGeometry finish(const View& view) {
    made.has_colors = !view.colors.empty();
    made.view = std::make_shared<const GeometryView>(view);
    return std::move(made);
  }
};

ArrayGeometry mesh(const Array& positions, const Maybe& faces, const std::string& kind,
                   const Maybe& offsets, const Maybe& normals, const std::string& normals_per,
                   const Maybe& texcoords, const std::string& texcoords_per, const Maybe& colors,
                   const std::string& colors_per, const Maybe& scalars,
                   const std::string& scalars_per) {
  Maker maker;
  MeshView v;
  v.positions = maker.take<Vec3>(positions, "positions");
  v.indices = maker.take_indices(faces, "faces");
  v.faces.kind = kind == "triangles" ? FaceKind::triangles
                 : kind == "quads"   ? FaceKind::quads
                 : kind == "strips"  ? FaceKind::strips
                                     : FaceKind::polygons;
  v.faces.offsets = maker.take_indices(offsets, "offsets");
  v.normals = {maker.take<Vec3>(normals, "normals"), {}, per_of(normals_per)};
  v.texcoords = {maker.take<Vec2>(texcoords, "uv"), {}, per_of(texcoords_per)};
  v.colors = {maker.take<Vec4>(colors, "colors"), {}, per_of(colors_per)};
  v.scalars = {maker.take_scalars(scalars), per_of(scalars_per)};
  return maker.finish(v);
}

ArrayGeometry points(const Array& positions, const Maybe& normals, const Maybe& colors,
                     const Maybe& sizes, float size, bool round, const Maybe& scalars) {
  Maker maker;
  PointsView v;
  v.positions = maker.take<Vec3>(positions, "positions");
  v.normals = maker.take<Vec3>(normals, "normals");
  v.sizes = maker.take<float>(sizes, "sizes");
  v.point_size = size;
  v.round = round;
  return maker.finish(v, colors, scalars);
}

ArrayGeometry lines(const Array& positions, const Maybe& segments, const Maybe& offsets,
                    bool polylines, const Maybe& colors, float width, const Maybe& scalars) {
  Maker maker;
  LinesView v;
  v.positions = maker.take<Vec3>(positions, "positions");
  v.indices = maker.take_indices(segments, "indices");
  v.kind = polylines ? LineKind::polylines : LineKind::segments;
  v.offsets = maker.take_indices(offsets, "offsets");
  v.line_width = width;
  return maker.finish(v, colors, scalars);
}

ArrayGeometry spheres(const Array& centers, const Maybe& radii, float radius, const Maybe& colors,
                      const Maybe& scalars) {
  Maker maker;
  SpheresView v;
  v.centers = maker.take<Vec3>(centers, "centers");
  return maker.finish(v, radii, radius, colors, scalars);
}

ArrayGeometry cylinders(const Array& positions, const Maybe& pairs, const Maybe& radii,
                        float radius, const Maybe& colors, bool caps, const Maybe& scalars) {
  Maker maker;
  CylindersView v;
  v.positions = maker.take<Vec3>(positions, "positions");
  v.indices = maker.take_indices(pairs, "indices");
  v.caps = caps;
  return maker.finish(v, radii, radius, colors, scalars);
}

ArrayGeometry tubes(const Array& positions, const Maybe& offsets, const Maybe& radii, float radius,
                    const Maybe& colors, const Maybe& scalars) {
  Maker maker;
  TubesView v;
  v.positions = maker.take<Vec3>(positions, "positions");
  v.offsets = maker.take_indices(offsets, "offsets");
  return maker.finish(v, radii, radius, colors, scalars);
}

ArrayGeometry discs(const Array& centers, const Array& normals, const Maybe& radii, float radius,
                    const Maybe& colors, const Maybe& scalars) {
  Maker maker;
  DiscsView v;
  v.centers = maker.take<Vec3>(centers, "centers");
  v.normals = maker.take<Vec3>(normals, "normals");
  return maker.finish(v, radii, radius, colors, scalars);
}

}  // namespace

void bind_geometries(nb::module_& m) {
  using nb::arg;
  nb::class_<ArrayGeometry>(m, "Geometry", "A geometry over arrays, which it keeps alive.")
      .def_prop_ro("primitives", [](const ArrayGeometry& g) { return primitive_count(*g.view); })
      .def(
          "prepared",
          [](const ArrayGeometry& g, int threads) {
            ArrayGeometry made = g;
            const nb::gil_scoped_release release;
            made.prepared =
                std::make_shared<const PreparedMesh>(std::get<MeshView>(*g.view), threads);
            made.view = std::make_shared<const GeometryView>(made.prepared->view());
            return made;
          },
          arg("threads"), "This mesh, ready for many frames, as another geometry.");
  m.def("mesh", mesh, arg("positions"), arg("faces").none(), arg("kind"), arg("offsets").none(),
        arg("normals").none(), arg("normals_per"), arg("texcoords").none(), arg("texcoords_per"),
        arg("colors").none(), arg("colors_per"), arg("scalars").none(), arg("scalars_per"));
  m.def("points", points, arg("positions"), arg("normals").none(), arg("colors").none(),
        arg("sizes").none(), arg("size"), arg("round"), arg("scalars").none());
  m.def("lines", lines, arg("positions"), arg("indices").none(), arg("offsets").none(),
        arg("polylines"), arg("colors").none(), arg("width"), arg("scalars").none());
  m.def("spheres", spheres, arg("centers"), arg("radii").none(), arg("radius"),
        arg("colors").none(), arg("scalars").none());
  m.def("cylinders", cylinders, arg("positions"), arg("indices").none(), arg("radii").none(),
        arg("radius"), arg("colors").none(), arg("caps"), arg("scalars").none());
  m.def("tubes", tubes, arg("positions"), arg("offsets").none(), arg("radii").none(), arg("radius"),
        arg("colors").none(), arg("scalars").none());
  m.def(
      "crease_normals",
      [](const nb::ndarray<const float, nb::c_contig, nb::device::cpu>& positions,
         const nb::ndarray<const std::uint32_t, nb::c_contig, nb::device::cpu>& corners,
         double degrees, const nb::ndarray<float, nb::c_contig, nb::device::cpu>& normals) {
        const std::span<const float> xyz(positions.data(), positions.size());
        std::vector<Vec3> points(xyz.size() / 3);
        for (std::size_t i = 0; i < points.size(); ++i)
          points[i] = {xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]};
        const nb::gil_scoped_release unlock;
        const Attribute<Vec3> found =
            rastrum::crease_normals(points, {corners.data(), corners.size()}, degrees);
        for (std::size_t i = 0; i < corners.size(); ++i) {
          const Vec3 n = found.values[found.indices[i]];
          std::copy_n(&n.x, 3, normals.data() + 3 * i);
        }
      },
      arg("positions"), arg("corners"), arg("degrees"), arg("normals"));
  m.def("discs", discs, arg("centers"), arg("normals"), arg("radii").none(), arg("radius"),
        arg("colors").none(), arg("scalars").none());
}

}  // namespace rastrum::python
