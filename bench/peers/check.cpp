// SPDX-License-Identifier: BSD-3-Clause
#include "check.hpp"

#include <rastrum/render.hpp>

namespace rastrum::bench {
GlCheck check_against(GlPeer& gl, const Mesh& mesh, const Camera& camera, int width, int height,
                      int threads) {
  Image<Rgba8> colors(width, height);
  Image<std::int64_t> ids(width, height);
  Image<std::uint32_t> counts(width, height);
  const MeshView view = mesh.view();
  const InstanceView instance{view};
  const FrameStats stats =
      Renderer({.threads = threads})
          .render({.instances = {&instance, 1}}, camera, {.width = width, .height = height},
                  {.color8 = colors, .ids = ids, .overdraw = counts});

  gl.set_mesh(view);
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
