// SPDX-License-Identifier: BSD-3-Clause
// Edges over a picture of ranks. The lines in a pixel depend only on the triangle seen there
// (docs/overlay.md). So the rank that has won the pixel computes the darkening factor, and sends it
// to the root for each darkened pixel.
#include <algorithm>
#include <array>

#include <rastrum/effects.hpp>
#include <rastrum/overlay/effects/edges.hpp>
#include <rastrum/ranks/parts_frame.hpp>

namespace rastrum::ranks {

void PartsFrame::send_edges(const Camera& camera, std::span<const BlockMask> won) {
  if (edges_ == nullptr) return;
  const Mail mail = sent_to_root("find edges", "make room for edges", [&](Bytes& to) {
    overlay::check_edge_width(edges_->lines.width_px);
    const SceneView scene = own_scene();
    const SceneEdges edges(scene, edges_->lines.angle_degrees);
    const Mat4d to_clip = world_to_clip(camera, frame_.width, frame_.height);
    std::vector<std::array<float, kPixels>> factors(won.size());
    std::vector<std::uint64_t> masks(won.size());
    const auto find = [&](std::size_t k) {
      overlay::TriangleSides sides(edges, to_clip, frame_.width, frame_.height,
                                   edges_->lines.width_px);
      const std::uint64_t* const keys = keys_.of(won[k].block);
      grid_->each_pixel(won[k], [&](int i, int x, int y) {
        const auto id = static_cast<std::int64_t>(raster::id_of_key(keys[i]));
        const float factor = sides.factor(id, x, y);
        factors[k][static_cast<std::size_t>(i)] = factor;
        masks[k] |= std::uint64_t{factor != 1} << i;
      });
    };
    for_each(won.size(), find, 8);
    for (std::size_t k = 0; k < won.size(); ++k) {
      if (masks[k] == 0) continue;
      put_mask(to, {masks[k], won[k].block});
      for (std::uint64_t m = masks[k]; m != 0; m &= m - 1)
        put(to, factors[k][static_cast<std::size_t>(std::countr_zero(m))]);
    }
  });
  phase("take edges", [&] {
    if (!is_root()) return;
    const ImageView<float> to = edges_->factor;
    for (int y = 0; y < to.height; ++y) std::fill_n(to.row(y), to.width, 1.0F);
    for (std::size_t r = 0; r < mail.ranks(); ++r)
      for (Reader from = mail.from(r); !from.at_end();)
        grid_->each_pixel(from.take_mask(),
                          [&](int, int x, int y) { to(x, y) = from.take<float>(); });
  });
}

void PartsFrame::draw_edges_alone(const Camera& camera, ImageView<const std::int64_t> ids) {
  if (edges_ == nullptr) return;
  phase("find edges", [&] {
    const RendererOptions& options = renderer_.options();
    const SceneView scene = own_scene();
    Effects(options.threads, options.isa)
        .edges(ids, SceneEdges(scene, edges_->lines.angle_degrees), camera, edges_->lines.width_px,
               edges_->factor);
  });
}

}  // namespace rastrum::ranks
