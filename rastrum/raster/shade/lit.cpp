// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/raster/shade/lit.hpp>

#include <algorithm>
#include <bit>
#include <cmath>

#include <rastrum/core/elementary.hpp>
#include <rastrum/raster/draws/interpolate.hpp>
#include <rastrum/raster/draws/shader_table.hpp>
#include <rastrum/raster/rules/srgb.hpp>
#include <rastrum/raster/shade/lit_constants.hpp>
#include <rastrum/raster/shade/lit_kernels.hpp>
#include <rastrum/raster/shade/lit_scalar.hpp>
#include <rastrum/raster/shade/wire.hpp>

namespace rastrum::raster {
namespace {

Vec4 opaque(Vec3 c) {
  return {c.x, c.y, c.z, 1};
}

Vec4 color(const LitShading& lit, const FrameGeometry& frame, const LocatedFragment& f) {
  if (lit.model == Shader::id) return opaque(id_color(f.id));
  const float line = wire_share(f);
  return opaque(wire_base(*lit.scene, frame, f) * (1 - line) + kWireColor * line);
}

void shade_scalar(const LitShading& lit, const FrameGeometry& frame, const VisibleBlock& block,
                  BlockColors& colors) {
  KeptTriangles& kept = *static_cast<KeptTriangles*>(block.scratch);
  const bool wants_normals = row_of(lit.model).normal;
  const LitView view = lit.scene->view();
  for (std::uint64_t m = block.covered; m != 0; m &= m - 1) {
    const int i = std::countr_zero(m);
    const int x = block.x0 + i % kBlockSize, y = block.y0 + i / kBlockSize;
    const LitTriangle& t = kept.find(*lit.scene, frame, block.keys[i] & kIdMask, wants_normals);
    const Vec2 from_centre =
        block.points == nullptr ? Vec2{0, 0} : Vec2{block.points->dx[i], block.points->dy[i]};
    colors.set(
        i, opaque(shade_lit(lit.model, view, t, x, y, from_centre, depth_of_key(block.keys[i]))));
  }
}

void set_normal_matrix(const Mat4d& object_to_world, float (&out)[3][3]) {
  // The cofactors are the inverse transpose up to the determinant. Its sign and size do not matter:
  // normals are normalized and turned to the viewer. Singular matrices have cofactors, too.
  const auto& m = object_to_world.m;
  double cofactor[3][3];
  double largest = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      cofactor[i][j] = m[i1][j1] * m[i2][j2] - m[i1][j2] * m[i2][j1];
      largest = std::max(largest, std::abs(cofactor[i][j]));
    }
  const double determinant =
      m[0][0] * cofactor[0][0] + m[0][1] * cofactor[0][1] + m[0][2] * cofactor[0][2];
  const double scale = largest > 0 ? (determinant < 0 ? -1 : 1) / largest : 0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) out[i][j] = static_cast<float>(cofactor[i][j] * scale);
}

/// The rays of any matrix with a centre of projection: the directions that rows x, y and w map to
/// (x_ndc, y_ndc, 1), by Cramer's rule.
ViewRays rays_of(const Mat4d& clip, int width, int height) {
  struct Row {
    double x, y, z;
  };
  const auto row = [&](int i) { return Row{clip.m[i][0], clip.m[i][1], clip.m[i][2]}; };
  const auto cross = [](Row a, Row b) {
    return Row{a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
  };
  const Row x = row(0), y = row(1), w = row(3);
  const Row to_x = cross(y, w), to_y = cross(w, x), to_w = cross(x, y);
  const double determinant = x.x * to_x.x + x.y * to_x.y + x.z * to_x.z;
  const auto direction = [&](double across, double up, double ahead) {
    const auto sum = [&](double a, double b, double c) {
      return static_cast<float>((across * a + up * b + ahead * c) / determinant);
    };
    return Vec3{sum(to_x.x, to_y.x, to_w.x), sum(to_x.y, to_y.y, to_w.y),
                sum(to_x.z, to_y.z, to_w.z)};
  };
  return {direction(-1, 1, 1), direction(2.0 / width, 0, 0), direction(0, -2.0 / height, 0)};
}

}  // namespace

ViewRays ViewRays::of(const Camera& camera, int width, int height) {
  const auto* const m = camera.matrix ? camera.matrix->m : nullptr;
  const bool parallel =
      m != nullptr ? m[3][0] == 0 && m[3][1] == 0 && m[3][2] == 0 : camera.orthographic;
  if (m != nullptr && !parallel) return rays_of(*camera.matrix, width, height);
  const Mat4d v = world_to_camera(camera);
  const auto axis = [&](int i, double scale) {
    return Vec3{static_cast<float>(v.m[i][0] * scale), static_cast<float>(v.m[i][1] * scale),
                static_cast<float>(v.m[i][2] * scale)};
  };
  if (parallel) return {axis(2, -1), {}, {}};
  const double half = elementary::tan(static_cast<double>(camera.fov_rad) / 2);
  const double per_px = 2 * half / std::min(width, height);
  const Vec3 dx = axis(0, per_px);
  const Vec3 dy = axis(1, -per_px);
  const Vec3 corner = axis(2, -1) + axis(0, -per_px * width / 2) + axis(1, per_px * height / 2);
  return {corner, dx, dy};
}

LitDraw LitDraw::of(const InstanceView& instance) const {
  LitDraw own = *this;
  // A view of the instance's own colour, which outlives the frame with the scene.
  if (instance.color) {
    own.colors = {.values = std::span(&*instance.color, 1), .per = Per::mesh};
    own.color_space = ColorSpace::display;
  }
  set_normal_matrix(instance.object_to_world, own.normal_matrix);
  const auto& m = own.normal_matrix;
  own.identity = m[0][0] == m[1][1] && m[1][1] == m[2][2] && m[0][0] > 0 && m[0][1] == 0 &&
                 m[0][2] == 0 && m[1][0] == 0 && m[1][2] == 0 && m[2][0] == 0 && m[2][1] == 0;
  return own;
}

LitScene::LitScene(const SceneView& scene, const Camera& camera, int width, int height)
    : rays(ViewRays::of(camera, width, height)) {
  draws.reserve(scene.instances.size());
  for (const InstanceView& instance : scene.instances) {
    LitDraw draw;
    draw.mesh = instance.mesh();
    if (const MeshView* const mesh = draw.mesh) {
      draw.colors = mesh->colors;
      draw.color_space = mesh->color_space;
      draw.material = instance.material.value_or(mesh->material);
      if (!instance.material) draw.face_materials = mesh->face_materials;
    }
    draws.push_back(draw.of(instance));
    colored |= !draws.back().colors.empty();
  }
  colored |= !scene.materials.empty();
  materials.reserve(scene.materials.size());
  for (const Material& m : scene.materials) {
    const Vec4 base = display_value(m.base_color);
    materials.push_back({base.x, base.y, base.z});
  }
}

void shade_lit_block(const LitShading& lit, const FrameGeometry& frame, const VisibleBlock& block,
                     Isa isa, BlockColors& colors) noexcept {
  if (const LitKernels* const lanes = lit_kernels(isa))
    return lanes->shade(lit, frame, block, colors);
  if (!is_light(lit.model)) {
    const FragmentShader scalar(
        [&lit](const FrameGeometry& g, const LocatedFragment& f) { return color(lit, g, f); });
    (void)scalar.shade(frame, block, isa, colors);
    return;
  }
  shade_scalar(lit, frame, block, colors);
}

}  // namespace rastrum::raster
