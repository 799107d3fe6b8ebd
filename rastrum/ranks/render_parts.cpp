// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/ranks/render_parts.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <optional>
#include <string_view>

#include <rastrum/core/enum.hpp>
#include <rastrum/core/float_scope.hpp>
#include <rastrum/core/reject.hpp>
#include <rastrum/error.hpp>
#include <rastrum/parallel/device.hpp>
#include <rastrum/ranks/of_scene.hpp>
#include <rastrum/ranks/parts_frame.hpp>
#include <rastrum/raster/kernels/kernels.hpp>
#include <rastrum/raster/resolve/resolve.hpp>
#include <rastrum/raster/rules/piece.hpp>
#include <rastrum/render/access.hpp>
#include <rastrum/render/depth_greys.hpp>
#include <rastrum/render/shadows.hpp>
#include <rastrum/render/target_checks.hpp>

namespace rastrum::ranks {
namespace {

void check_root_targets(const Targets& targets, const FrameOptions& o) {
  check_targets(targets, o);
  if (!targets.overdraw.empty() || !targets.errors.empty() || !targets.keys.empty() ||
      !targets.extra.empty())
    throw Error(Errc::unsupported,
                "a picture of several ranks has no targets overdraw, errors, keys and extra");
}

/// Hash (FNV-1a) of options that must be the same on all ranks. Differences in others show in the
/// picture.
std::uint64_t fingerprint(const Camera& camera, const FrameOptions& o, const RanksOptions& r) {
  std::uint64_t hash = 0xCBF29CE484222325U;
  const auto add = [&](const auto& value) {
    for (const std::byte b : std::as_bytes(std::span(&value, 1)))
      hash = (hash ^ std::to_integer<std::uint64_t>(b)) * 0x100000001B3U;
  };
  add(world_to_clip(camera, o.width, o.height));
  for (const int number :
       {o.width, o.height, r.root, static_cast<int>(o.shader), static_cast<int>(o.cull),
        static_cast<int>(o.transparency.method), static_cast<int>(r.exchange),
        static_cast<int>(o.tone.tone), static_cast<int>(o.lights.size()), o.samples,
        o.shadows ? 1 : 0, r.rows, o.shadow_size})
    add(number);
  // Lights count only by what decides who has a shadow, and how bright each is.
  for (const Light& light : o.lights) {
    add(light.kind.index());
    add(has_shadow(light));
    add(light.of_camera);
    add(light.color);
    add(light.intensity);
  }
  for (const float number : {o.opacity, o.background.x, o.background.y, o.background.z,
                             o.background.w, o.tone.exposure_stops})
    add(number);
  for (const ClipPlane& plane : o.clip_planes) add(plane);
  add(o.shadow_distance);
  return hash;
}

}  // namespace

void PartsFrame::begin(const SceneView& scene, std::span<const std::uint64_t> parts,
                       const Camera& camera) {
  // All that ranks must know of each other before they draw goes with the first agreement.
  enum { kPrint, kOpposite, kRanges, kWith, kWithout, kNoLimit, kNumbers };
  std::array<std::uint64_t, kNumbers> told{};
  static_assert(kNumbers <= kMostNumbers);
  const auto size = static_cast<std::uint64_t>(ranks_.size());
  const auto look = [&] {
    check(frame_);
    check_enum(options_.exchange, WordExchange::shared, "the exchange of words");
    if (options_.root < 0 || options_.root >= ranks_.size())
      reject("the root is rank ", options_.root, ", but there are ", ranks_.size(), " ranks");
    if (frame_.environment_behind)
      throw Error(Errc::unsupported,
                  "a picture of several ranks: the environment behind it (environment_behind) is "
                  "not drawn");
    check_band_rows(options_.rows);
    scene_ = scene;
    own_.emplace(scene, parts);
    const bool has_parts = !own_->parts.empty(), has_materials = !scene_.materials.empty();
    const std::uint64_t limit = renderer_.options().memory_limit;
    told[kPrint] = fingerprint(camera, frame_, options_);
    told[kOpposite] = ~told[kPrint];
    told[kRanges] = std::ranges::any_of(scene_.scalar_mappings, takes_range) ? 1 : 0;
    told[kWith] = has_parts && has_materials ? 1 : 0;
    // The lowest such rank has the greatest number.
    if (has_parts && !has_materials)
      told[kWithout] = size - static_cast<std::uint64_t>(ranks_.rank());
    told[kNoLimit] = limit == 0 ? 0 : ~limit;
  };
  phase("check", look, told);
  // All ranks have the same numbers, so all throw the same.
  if (told[kPrint] != ~told[kOpposite])
    reject("rank 0: the ranks were given different cameras, frames or options");
  if (told[kWith] != 0 && told[kWithout] != 0)
    reject("rank ", size - told[kWithout],
           ": its scene has no materials, but that of another rank has; give it plain "
           "ones (add_plain_materials)");
  if (frame_.shader == Shader::automatic)
    frame_.shader = told[kWith] != 0 ? Shader::material : Shader::phong;
  if (told[kRanges] != 0) {
    mappings_ = mappings_of(ranks_, at_, scene_);
    scene_.scalar_mappings = mappings_;
  }
  share_words(~told[kNoLimit]);
}

void PartsFrame::share_words(std::uint64_t least_limit) {
  if (ranks_.size() == 1 ||
      (options_.exchange != WordExchange::automatic && options_.exchange != WordExchange::shared))
    return;
  const int rows = options_.rows == 0 ? frame_.height : std::min(options_.rows, frame_.height);
  const auto blocks = [](int pixels) {
    return static_cast<std::uint64_t>((pixels + kSide - 1) / kSide);
  };
  const std::uint64_t count = blocks(frame_.width) * blocks(rows);
  const std::uint64_t table = SharedLayers::table_size(count, ranks_.size());
  // Without a limit, the usual most: where the picture is large, sparse words may be few.
  most_shared_ = std::min(least_limit / 4, std::uint64_t{1} << 30) / sizeof(std::uint64_t);
  words_of_surface_ = count * kPixels;
  if (words_of_surface_ + table > most_shared_) return;
  surface_ = ranks_.share(words_of_surface_ + table);
  if (surface_.size() > most_shared_) surface_ = surface_.first(most_shared_);
  if (own_rank() == 0 && !surface_.empty())
    SharedLayers(surface_.subspan(words_of_surface_), count, ranks_.size()).clear_room();
}

void PartsFrame::ask(const Targets& callers) {
  locally("ask", [&] {
    if (!is_root()) return;
    FrameOptions held = frame_;
    if (options_.rows != 0) held.height = std::min(options_.rows, frame_.height);
    check_root_targets(callers, held);
    const Targets targets = wide_.widen(callers, held.width, held.height);
    check_outputs(targets, true, frame_.shader == Shader::material);
    filled_ = targets;
    tones_ = TonePass::wanted(frame_, targets, frame_.shader);
    if (tones_) filled_ = tone_.targets(held, targets);
    const bool greys =
        frame_.shader == Shader::depth && !(targets.color8.empty() && targets.color.empty());
    if (greys && options_.rows != 0)
      throw Error(Errc::unsupported,
                  "a picture in bands of rows: the shader depth stretches the depths of a whole "
                  "picture");
    check_bands_taken(options_.rows, frame_.height, static_cast<bool>(options_.take_rows));
    if (greys) {
      filled_.color8 = {};
      filled_.color = {};
      if (filled_.depth.empty()) {
        depth_ = Image<float>(held.width, held.height);
        filled_.depth = depth_;
      }
    }
    asked_ = targets_asked(filled_);
  });
}

void PartsFrame::list_parts() {
  std::uint64_t asked = 0;
  Mail mail = packed("tell parts",
                     [&](Mail& to) {
                       PartList::tell(*own_, to);
                       asked = asked_;  // the root's
                     },
                     {&asked, 1});
  asked_ = static_cast<std::uint32_t>(asked);
  exchange(mail, "make room for parts");
  phase("list parts", [&] {
    list_.emplace(mail);
    places_ = list_->places_of(ranks_.rank());
    only_root_.push_back(root());
    for (std::size_t r = 0; is_root() && r < static_cast<std::size_t>(ranks_.size()); ++r)
      senders_to_me_.push_back(r);
  });
}

bool PartsFrame::takes_hops(Mail& mail) {
  if (options_.exchange == WordExchange::two_hops) return mail.ranks() > 1;
  // Within one machine a message costs less than the detour over a third rank.
  const bool chooses =
      options_.exchange == WordExchange::automatic || options_.exchange == WordExchange::shared;
  if (!chooses || !surface_.empty() || mail.ranks() < kLeastForHops) return false;
  std::uint64_t bytes = 0, receivers = 0;
  for (std::size_t r = 0; r < mail.ranks(); ++r) {
    if (r == static_cast<std::size_t>(ranks_.rank()) || mail.to(r).empty()) continue;
    bytes += mail.to(r).size();
    ++receivers;
  }
  return hops_cost_less(ranks_, bytes, receivers);
}

void PartsFrame::exchange(Mail& mail, std::string_view room) {
  (takes_hops(mail) ? exchange_by_hops : exchange_with_all)(ranks_, at_, mail, room);
}

void PartsFrame::draw_alone(const Camera& camera, const Targets& targets) {
  phase("draw", [&] {
    const FrameStats stats = renderer_.render(own_scene(), camera, frame_, targets);
    stats_.words = stats_.won = stats.pixels_covered;
    finish_rows("draw", frame_.height);
  });
}

/// The same for a band.
void PartsFrame::draw_band_alone(const Camera& camera) {
  phase("draw", [&] {
    const FrameStats stats = RendererAccess::render(renderer_, own_scene(), camera, untoned(),
                                                    in_place(filled_, band_.y0), {},
                                                    {.part = band_, .shadows = shadows_});
    stats_.words += stats.pixels_covered;
    stats_.won = stats_.words;
  });
}

/// A device does not pass opaque surfaces to a sink; it fills an image of keys instead.
SparseBlocks* PartsFrame::keys_of_sink() {
  return renderer_.options().device == Device::cuda ? nullptr : &keys_;
}

FrameStats PartsFrame::draw_own(const Camera& camera, const FrameOptions& frame, KeySink& sink,
                                std::span<const raster::LightShadow> shadows) {
  keys_ = SparseBlocks(grid_->count());
  Targets targets;
  Image<std::uint64_t> image;
  if (keys_of_sink() == nullptr) {
    image = Image<std::uint64_t>(frame_.width, band_.y1 - band_.y0);
    targets.keys = in_place(image.view(), band_.y0);
  }
  FrameStats stats = RendererAccess::render(renderer_, own_scene(), camera, frame, targets, {},
                                            {.sink = &sink, .part = part(), .shadows = shadows});
  if (keys_of_sink() == nullptr) keys_ = SparseBlocks(*grid_, targets.keys);
  return stats;
}

FrameStats PartsFrame::draw_survey(const Camera& camera) {
  survey_.emplace(*grid_, keys_of_sink());
  return draw_own(camera, unlit(), *survey_);
}

/// With Shader::id, a pass may draw only neighbouring parts (end_of_run), and needs to know
/// beforehand what hides its fragments.
bool PartsFrame::draw_surfaces(const Camera& camera) {
  std::array<std::uint64_t, 3> told{};
  phase(
      "draw",
      [&] {
        if (own_->parts.empty()) return;
        if (frame_.shader == Shader::id) {
          translucent_ = draw_survey(camera).visibility == "layers";
          if (!translucent_) survey_.reset();
        } else {
          hold_fragments(camera);
        }
        told = {translucent_ ? 1U : 0U, (held_ && held_->is_full()) || survey_ ? 1U : 0U,
                keys_.any() ? 1U : 0U};
      },
      told);
  in_bands_ = told[1] != 0;
  any_keys_ = told[2] != 0;
  return told[0] != 0;
}

void PartsFrame::draw_as_opaque(const Camera& camera) {
  phase("draw as opaque", [&] {
    if (own_->parts.empty()) return;
    KeySink sink(raster::Translucent::left_out, *grid_, keys_of_sink());
    (void)draw_own(camera, unlit_opaque(), sink);
  });
}

Words::Won PartsFrame::meet() {
  std::optional<Words> words;
  phase("make words", [&] {
    words.emplace(*grid_, keys_, *own_, places_);
    clear_own_words();
  });
  if (surface_.empty()) return words->meet(ranks_, at_, *list_, options_.exchange);
  Words::Won won;
  phase("raise words", [&] { words->raise(surface_); });
  locally("look who has won", [&] { won = words->look(surface_, true); });
  return won;
}

void PartsFrame::clear_own_words() {
  if (!surface_.empty())
    Words::clear_own(*grid_, static_cast<std::size_t>(ranks_.rank()), surface_);
}

std::size_t PartsFrame::end_of_run(std::size_t first) const {
  std::size_t last = first + 1;
  while (last < places_.size() &&
         (frame_.shader != Shader::id || places_[last] == places_[last - 1] + 1))
    ++last;
  return last;
}

/// Depths and ids of the pixels that this rank has won; both follow from its keys.
void PartsFrame::tell_known(std::span<const BlockMask> won) {
  const Targets& own = pixels_->targets();
  for (std::size_t k = 0; k < won.size() && !(own.depth.empty() && own.ids.empty()); ++k)
    for (std::uint64_t m = won[k].mask; m != 0; m &= m - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(m));
      const std::uint64_t key = keys_.of(won[k].block)[i], id = raster::id_of_key(key);
      if (!own.depth.empty()) own.depth.data[k * kPixels + i] = raster::depth_of_key(key);
      if (own.ids.empty()) continue;
      const std::size_t part = own_->instance_of(id);
      own.ids.data[k * kPixels + i] = static_cast<std::int64_t>(
          list_->parts()[places_[part]].first_id + id - own_->first_ids[part]);
    }
}

/// Shades the pixels that this rank has won from their keys: nothing is rasterized again.
void PartsFrame::shade(const Camera& camera, const FrameOptions& frame, std::uint32_t asked,
                       std::span<const BlockMask> won) {
  locally("shade", [&] {
    pixels_.emplace(asked, won.size());
    if (won.empty()) return;
    tell_known(won);
    if ((asked & ~kKnownTargets) == 0) return;
    std::vector<raster::KnownBlock> blocks;
    for (std::size_t first = 0, last = 0; first < places_.size(); first = last) {
      last = end_of_run(first);
      const std::uint64_t lowest = own_->first_ids[first], end = own_->first_ids[last];
      blocks.clear();
      std::vector<std::size_t> place_of;
      for (std::size_t k = 0; k < won.size(); ++k) {
        const std::uint64_t* const keys = keys_.of(won[k].block);
        std::uint64_t mask = won[k].mask;
        if (last - first != places_.size())
          for (std::uint64_t m = mask; m != 0; m &= m - 1) {
            const std::uint64_t id = raster::id_of_key(keys[std::countr_zero(m)]);
            if (id < lowest || id >= end) mask &= ~(m & (~m + 1));
          }
        if (mask == 0) continue;
        blocks.push_back({keys, mask, grid_->x_of(won[k].block), grid_->y_of(won[k].block)});
        place_of.push_back(k);
      }
      if (blocks.empty()) continue;
      const raster::KnownBlocks known{blocks, first_id_of(first) - lowest, [&](std::size_t i) {
                                        return pixels_->at(place_of[i], blocks[i].x0, blocks[i].y0);
                                      }};
      const Targets own = targets_of(pixels_->targets(), ~kKnownTargets);
      (void)RendererAccess::shade(renderer_, own_scene(first, last), camera, frame, own,
                                  {.first_id = first_id_of(first)}, known, shadows_);
    }
  });
}

void PartsFrame::gather(std::span<const BlockMask> won, std::uint32_t asked) {
  const Mail mail = sent_to_root("pack pixels", "make room for pixels", [&](Bytes& to) {
    send_pixels(won, *pixels_, to);
    pixels_.reset();
  });
  locally("take pixels", [&] {
    if (!is_root()) return;
    const Targets targets = targets_of(filled_, asked);
    show_nothing(targets);
    const Targets placed = in_place(targets, band_.y0);
    // No two ranks store the same pixel, so threads need no locks.
    for_each(mail.ranks(), [&](std::size_t r) { take_pixels(*grid_, mail.from(r), placed); });
  });
}

/// Fills all pixels as a scene without instances does.
void PartsFrame::show_nothing(const Targets& targets) const {
  raster::FrameRequest request;
  request.width = frame_.width;
  request.height = band_.y1 - band_.y0;
  request.background = frame_.background;
  request.no_distance = frame_.no_distance;
  request.linear_light = frame_.shader == Shader::material && !targets.linear.empty();
  request.targets = targets;
  const auto plan = raster::FramePlan::of(request, true, false);
  const auto fill = [&](std::size_t row) {
    const int y = static_cast<int>(row) * kSide;
    raster::resolve_empty(request, plan,
                          {0, y, request.width, std::min(y + kSide, request.height)});
  };
  const auto rows = static_cast<std::size_t>((request.height + kSide - 1) / kSide);
  for_each(rows, fill);
}

void PartsFrame::finish(const Targets& targets) {
  phase("finish", [&] {
    // For the next rows.
    if (own_rank() == 0 && !surface_.empty()) shared_layers().clear_room();
    if (is_root()) {
      FrameOptions of_band = frame_;
      of_band.height = band_.y1 - band_.y0;
      if (tones_) tone_.draw(of_band, targets, nullptr);
      if (frame_.shader == Shader::depth && !filled_.depth.empty())
        stretch_depth(filled_.depth, frame_.background, targets,
                      choose_isa(renderer_.options().isa), RendererAccess::threads(renderer_));
      wide_.narrow(targets);
    }
    finish_rows("finish", band_.y1);
  });
}

RanksStats PartsFrame::draw(const SceneView& scene, std::span<const std::uint64_t> parts,
                            const Camera& camera, const Targets& targets) {
  begin(scene, parts, camera);
  ask(targets);
  list_parts();
  stats_.primitives = list_->primitives();
  stats_.exchange = options_.exchange;
  if (!surface_.empty())
    stats_.exchange = WordExchange::shared;
  else if (options_.exchange == WordExchange::automatic ||
           (options_.exchange == WordExchange::shared && ranks_.size() > 1))
    stats_.exchange = WordExchange::sparse;
  refuse_approximations(camera);
  band_ = {0, 0, frame_.width, frame_.height};
  if (ranks_.size() == 1 && options_.rows == 0) {
    draw_alone(camera, targets);
    draw_edges_alone(camera, targets.ids);
    return stats_;
  }
  draw_shadows(camera);
  if (frame_.samples > 1 && frame_.shader != Shader::depth && (asked_ & kColorTargets) != 0)
    agree_on_linear_light(camera);
  if (options_.rows == 0) {
    draw_rows(camera, targets);
    return stats_;
  }
  const Targets whole = filled_;
  for (int y = 0; y < frame_.height; y += options_.rows) {
    band_ = {0, y, frame_.width, std::min(y + options_.rows, frame_.height)};
    filled_ = first_rows(whole, band_.y1 - y);
    draw_rows(camera, first_rows(targets, band_.y1 - y));
    phase("take rows", [&] {
      if (is_root() && options_.take_rows) options_.take_rows(band_.y0, band_.y1);
    });
  }
  return stats_;
}

/// Draws the rows of band_; all agreements that do not depend on rows have been made.
void PartsFrame::draw_rows(const Camera& camera, const Targets& targets) {
  locally("begin rows", [&] {
    pixels_.reset();
    picture_.reset();
    held_.reset();
    survey_.reset();
    translucent_ = shares_layers_ = false;
    asks_.clear();
    answers_.clear();
    hides_.clear();
    grid_.emplace(frame_.width, band_.y0, band_.y1, ranks_.size());
    if (!surface_.empty()) shared_layers().clear(own_rank());
    keys_ = SparseBlocks(grid_->count());
  });
  if (ranks_.size() == 1)
    draw_band_alone(camera);
  else if (frame_.samples > 1)
    draw_samples(camera);
  else
    draw_surfaces_of_rows(camera);
  finish(targets);
}

void PartsFrame::draw_surfaces_of_rows(const Camera& camera) {
  FrameOptions alone = untoned();
  std::uint32_t of_nearest = asked_;
  const bool has_colors = (asked_ & kColorTargets) != 0;
  const bool has_layers = has_colors && draw_surfaces(camera);
  if (has_layers) {
    layers(camera);
    // All other targets show the nearest surfaces, whatever their alpha.
    of_nearest &= ~kColorTargets;
  }
  if (has_layers || !has_colors) {
    alone.transparency.method = Transparency::none;
    // Draws even if no target is asked for, so that a scene that cannot be drawn fails.
    if (of_nearest != 0 || !has_colors) draw_as_opaque(camera);
  }
  if (!has_layers || of_nearest != 0) {
    const Words::Won won = meet();
    shade(camera, alone, of_nearest, won.blocks);
    gather(won.blocks, of_nearest);
    send_edges(camera, won.blocks);
    if (!has_layers) note(won);
  }
}

void PartsFrame::note(const Words::Won& won) {
  stats_.exchange = won.taken;
  stats_.words += won.words;
  for (const BlockMask& b : won.blocks) stats_.won += static_cast<unsigned>(std::popcount(b.mask));
}

RanksStats render_parts(Communicator& ranks, Renderer& renderer, const SceneView& scene,
                        std::span<const std::uint64_t> parts, const Camera& camera,
                        const FrameOptions& frame, const Targets& targets,
                        const RanksOptions& options, const AtPhase& at, const EdgesOfParts* edges,
                        StopToken stop) {
  const FloatScope floats;
  const StopScope scope(stop);
  return PartsFrame(ranks, renderer, frame, options, at, edges).draw(scene, parts, camera, targets);
}

}  // namespace rastrum::ranks

namespace rastrum {

std::string_view name(WordExchange exchange) noexcept {
  constexpr std::string_view kNames[] = {"automatic", "sparse", "two_hops", "shared"};
  return kNames[static_cast<std::size_t>(exchange)];
}

RanksStats render_parts(Communicator& ranks, Renderer& renderer, const SceneView& scene,
                        std::span<const std::uint64_t> parts, const Camera& camera,
                        const FrameOptions& frame, const Targets& targets,
                        const RanksOptions& options, StopToken stop) {
  return rastrum::ranks::render_parts(ranks, renderer, scene, parts, camera, frame, targets,
                                      options, {}, nullptr, stop);
}

}  // namespace rastrum
