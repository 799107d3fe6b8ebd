// Draws with both and compares; see the header.
#include "check.hpp"

#include <rastrum/render.hpp>

namespace rastrum::bench {
namespace {

/// The scene of one mesh; the mesh must outlive it.
struct OneMesh {
  InstanceView instance;

  explicit OneMesh(const Mesh& mesh) : instance{mesh.view(), Mat4d::identity()} {}
  [[nodiscard]] SceneView view() const { return {.instances = {&instance, 1}}; }
};

}  // namespace

Camera fit(const Mesh& mesh) {
  return fit_camera(OneMesh(mesh).view(), Camera{}.fov_rad, false);
}

GlCheck check_against(GlPeer& gl, const Mesh& mesh, const Camera& camera, int width, int height,
                      int threads) {
  Image<Rgba8> colors(width, height);
  Image<std::int64_t> ids(width, height);
  Image<std::uint32_t> counts(width, height);
  const FrameStats stats =
      Renderer({.threads = threads})
          .render(OneMesh(mesh).view(), camera, {.width = width, .height = height},
                  {.color8 = colors, .ids = ids, .overdraw = counts});

  gl.set_mesh(mesh.view());
  gl.set_view(camera, width, height);
  GlCheck check;
  check.triangles = mesh.triangle_count();
  check.counts = compare_counts(counts, gl.fragment_counts());
  check.samples_passed = gl.samples_passed();
  check.stats_fragments = stats.fragments;
  gl.draw_phong();
  check.colors = compare_colors(colors, gl.colors(), 1);
  gl.draw_ids();
  check.ids = count_different(ids, gl.ids());
  return check;
}

}  // namespace rastrum::bench
