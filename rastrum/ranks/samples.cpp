// SPDX-License-Identifier: BSD-3-Clause
// Frames with several samples per pixel. Each sample has its own surface and layers, so ranks
// exchange fragments of samples, opaque ones too. Their owner blends each sample and takes the
// mean. Targets other than colours show one surface per pixel, that with the largest key of any
// sample, which words decide as with one sample.
#include <rastrum/ranks/parts_frame.hpp>

namespace rastrum::ranks {

void PartsFrame::draw_samples(const Camera& camera) {
  if (frame_.shader != Shader::depth && (asked_ & kColorTargets) != 0) {
    begin_picture();
    std::uint64_t is_full = 0;
    phase("draw samples",
          [&] {
            if (!own_->parts.empty()) hold_fragments(camera);
            is_full = held_ && held_->is_full() ? 1 : 0;
          },
          {&is_full, 1});
    if (is_full != 0) {
      locally("count fragments of samples", [&] {
        held_.reset();
        if (!own_->parts.empty()) (void)draw_survey(camera);
      });
      draw_bands(camera);
    } else {
      share_layers();
      look_behind_samples();
      blend_held();
    }
    finish_picture();
  }
  const std::uint32_t of_nearest = asked_ & ~kColorTargets;
  if (of_nearest == 0) return;
  std::optional<OwnImages> images;
  // Draws all targets of the nearest surfaces into the rank's own images. Where the rank wins, they
  // are those of the whole scene.
  phase("draw as opaque", [&] {
    images.emplace(of_nearest & ~kKnownTargets, band_);
    if (own_->parts.empty()) return;
    Targets own = images->targets();
    Image<std::uint64_t> keys(frame_.width, band_.y1 - band_.y0);
    own.keys = in_place(keys.view(), band_.y0);
    (void)RendererAccess::render(renderer_, own_scene(), camera, unlit_opaque(), own, {},
                                 {.part = part()});
    keys_ = SparseBlocks(*grid_, own.keys);
  });
  const Words::Won won = meet();
  note(won);
  locally("take what was won", [&] {
    pixels_.emplace(of_nearest, won.blocks.size());
    if (!won.blocks.empty()) pixels_->take(*grid_, won.blocks, images->targets());
    images.reset();
    tell_known(won.blocks);
  });
  gather(won.blocks, of_nearest);
  send_edges(camera, won.blocks);
}

/// Tells ranks which fragments not to send: those behind an opaque surface that some rank has in
/// all samples of the pixel.
void PartsFrame::look_behind_samples() {
  std::optional<Words> words;
  phase("find what hides", [&] {
    words.emplace(*grid_,
                  held_ ? held_->hiding(*grid_, frame_.samples) : SparseBlocks(grid_->count()));
    clear_own_words();
  });
  if (surface_.empty()) return ask_what_hides(words->meet_owners(ranks_, at_, options_.exchange));
  phase("raise what hides", [&] { words->raise(surface_); });
  ask_what_hides(words->look(surface_, false));
}

/// A renderer shades all materials in linear light if any surface of the scene is translucent,
/// visible or not. An empty translucent mesh stands for those of other ranks.
void PartsFrame::agree_on_linear_light(const Camera& camera) {
  const bool any =
      frame_.shader == Shader::material && finds_layers(camera, frame_.transparency.method);
  phase("stand in for layers", [&] {
    linear_light_ = frame_.shader == Shader::material && (any || (asked_ & kLinearTarget) != 0);
    if (linear_light_ && !translucent_ && !own_->parts.empty())
      own_->instances.push_back({.opacity = 0.5F});
  });
}

}  // namespace rastrum::ranks
