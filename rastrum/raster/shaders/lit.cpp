#include <rastrum/raster/shaders/lit.hpp>

#include <algorithm>
#include <cmath>

#include <rastrum/raster/interpolate.hpp>
#include <rastrum/raster/shaders/lit_constants.hpp>
#include <rastrum/raster/shaders/normals.hpp>

namespace rastrum::raster {
namespace {

Vec3 world_normal(const LitDraw& draw, const Fragment& f) {
  Vec3 corners[3];
  corner_normals(draw.mesh, f.triangle, f.vertex, corners);
  Vec3 n;
  for (int c = 0; c < 3; ++c) n = n + corners[c] * static_cast<float>(f.weights.b[c]);
  return normalize(draw.to_world(n));
}

Vec3 base_color(const MeshView& mesh, const Fragment& f) {
  if (mesh.colors.empty()) return kDefaultBase;
  Vec3 sum;
  for (int c = 0; c < 3; ++c) {
    const std::size_t i = mesh.colors.indices.empty()
                              ? f.vertex[c]
                              : mesh.colors.indices[f.triangle * 3 + static_cast<std::size_t>(c)];
    const Vec4 v = mesh.colors.values[i];
    sum = sum + Vec3{v.x, v.y, v.z} * static_cast<float>(f.weights.b[c]);
  }
  return sum;
}

Vec4 opaque(Vec3 c) {
  return {c.x, c.y, c.z, 1};
}

/// How much of a line about a pixel wide along the triangle's edges covers the sample, in [0, 1].
float wire(const Fragment& f) {
  double nearest = 1e9;
  for (int i = 0; i < 3; ++i) {
    const WeightPlanes& w = *f.planes;
    const double b = w.r[i] + w.p[i] * (f.x + 0.5 - w.x0) + w.q[i] * (f.y + 0.5 - w.y0);
    nearest = std::min(nearest, std::abs(b) / std::hypot(w.p[i], w.q[i]));
  }
  return static_cast<float>(std::clamp(1.0 - nearest, 0.0, 1.0));
}

class LitShader final : public BlockShader {
 public:
  LitShader(LitModel model, const LitScene& scene) : model_(model), scene_(scene) {}

  bool shade(const FrameGeometry& frame, const VisibleBlock& block, Isa isa,
             BlockColors& colors) const noexcept override {
    if (isa != Isa::scalar && shade_lit_simd(isa, model_, scene_, frame, block, colors))
      return true;
    const FragmentShader scalar(
        [this](const FrameGeometry&, const Fragment& f) { return color(f); });
    return scalar.shade(frame, block, isa, colors);
  }

  [[nodiscard]] std::size_t scratch_bytes() const noexcept override { return lit_scratch_bytes(); }

 private:
  [[nodiscard]] Vec4 color(const Fragment& f) const {
    const LitDraw& draw = scene_.draws[f.draw];
    switch (model_) {
      case LitModel::flat:
        return opaque(base_color(draw.mesh, f));
      case LitModel::normal:
        return opaque(world_normal(draw, f) * 0.5F + Vec3{0.5F, 0.5F, 0.5F});
      case LitModel::id:
        return opaque(id_color(f.id));
      case LitModel::wireframe: {
        const float line = wire(f);
        return opaque(base_color(draw.mesh, f) * (1 - line) + kWireColor * line);
      }
      case LitModel::lambert:
      case LitModel::phong:
        break;
    }
    const ViewRays& rays = scene_.rays;
    const float px = static_cast<float>(f.x) + 0.5F;
    const float py = static_cast<float>(f.y) + 0.5F;
    const Vec3 v = normalize(-(rays.d + rays.dx * px + rays.dy * py));
    Vec3 n = world_normal(draw, f);
    if (dot(n, v) < 0) n = -n;
    const float diffuse = kAmbient + kDiffuse * std::max(dot(n, kLight), 0.0F);
    const Vec3 lit = base_color(draw.mesh, f) * diffuse;
    if (model_ == LitModel::lambert) return opaque(lit);
    float s = std::max(dot(n, normalize(v + kLight)), 0.0F);
    for (int i = 0; i < 5; ++i) s *= s;
    return opaque(lit + Vec3{s, s, s} * kSpecular);
  }

  LitModel model_;
  const LitScene& scene_;
};

void normal_matrix(const Mat4d& object_to_world, float (&out)[3][3]) {
  // The cofactors are the inverse transpose up to the determinant, whose sign and size do not
  // matter: normals are normalized and turned to the viewer. They also exist where the matrix is
  // singular.
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

}  // namespace

ViewRays ViewRays::of(const Camera& camera, int width, int height) {
  const Mat4d v = world_to_camera(camera);
  const auto axis = [&](int i, double scale) {
    return Vec3{static_cast<float>(v.m[i][0] * scale), static_cast<float>(v.m[i][1] * scale),
                static_cast<float>(v.m[i][2] * scale)};
  };
  if (camera.orthographic) return {axis(2, -1), {}, {}};
  const double half = std::tan(static_cast<double>(camera.fov_rad) / 2);
  const double per_px = 2 * half / std::min(width, height);
  const Vec3 dx = axis(0, per_px);
  const Vec3 dy = axis(1, -per_px);
  const Vec3 corner = axis(2, -1) + axis(0, -per_px * width / 2) + axis(1, per_px * height / 2);
  return {corner, dx, dy};
}

LitScene::LitScene(const SceneView& scene, const Camera& camera, int width, int height)
    : rays(ViewRays::of(camera, width, height)) {
  draws.reserve(scene.instances.size());
  for (const InstanceView& instance : scene.instances) {
    LitDraw& draw = draws.emplace_back();
    draw.mesh = instance.mesh;
    normal_matrix(instance.object_to_world, draw.normal_matrix);
    const auto& m = draw.normal_matrix;
    draw.identity = m[0][0] == m[1][1] && m[1][1] == m[2][2] && m[0][0] > 0 && m[0][1] == 0 &&
                    m[0][2] == 0 && m[1][0] == 0 && m[1][2] == 0 && m[2][0] == 0 && m[2][1] == 0;
    colored |= !draw.mesh.colors.empty();
  }
}

std::unique_ptr<BlockShader> make_lit_shader(LitModel model, const LitScene& scene) {
  return std::make_unique<LitShader>(model, scene);
}

}  // namespace rastrum::raster
