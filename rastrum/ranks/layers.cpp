// SPDX-License-Identifier: BSD-3-Clause
// The colours of a frame with translucent surfaces. Opaque surfaces meet as words; the rank that
// wins a pixel shades it. Translucent fragments in front go to their block's owner, which blends
// those of all ranks. The root blends the result over the opaque colours, and that over the
// background.
#include <algorithm>
#include <bit>
#include <utility>

#include <rastrum/device.hpp>
#include <rastrum/error.hpp>
#include <rastrum/ranks/bands.hpp>
#include <rastrum/ranks/layer_merge.hpp>
#include <rastrum/ranks/parts_frame.hpp>
#include <rastrum/raster/kernels/kernels.hpp>

namespace rastrum::ranks {
namespace {

using raster::kBinSize;
using raster::Rect;

/// The key of pixels where no fragment of this rank is visible: nearer than any surface, and of no
/// pass. The depth is below 2, whose bits would make the key negative in kernels that compare
/// signed numbers.
constexpr std::uint64_t kNearest = std::uint64_t{std::bit_cast<std::uint32_t>(1.5F)}
                                       << raster::kIdBits |
                                   (raster::kIdMask - raster::kMaxId);

/// The target for opaque colours as blending needs them: premultiplied, over nothing, in linear
/// light for Shader::material. kLinearTarget makes a renderer shade the whole picture in linear
/// light, as it does where something is translucent.
std::uint32_t behind_target(Shader shader) {
  return shader == Shader::material ? kLinearTarget : kColorTarget;
}

}  // namespace

/// Whether any rank has surfaces that blend. A renderer finds out only as it prepares its draws, so
/// each rank draws one pixel, with a sink that takes no fragments.
bool PartsFrame::finds_layers(const Camera& camera, Transparency method) {
  phase("look for layers", [&] {
    if (own_->parts.empty()) return;
    FrameOptions smallest = frame_;
    smallest.width = smallest.height = smallest.samples = 1;
    smallest.transparency.method = method;
    smallest.lights.clear();
    smallest.tone = {};
    Image<std::uint64_t> key(1, 1);
    Targets targets;
    targets.keys = key;
    raster::FragmentSink without(raster::Translucent::left_out);
    translucent_ = RendererAccess::render(renderer_, own_scene(), camera, smallest, targets, {},
                                          {.sink = &without})
                       .visibility == "layers";
  });
  return ranks_.max(translucent_ ? 1 : 0) != 0;
}

/// Refuses approximate methods, which would see only one rank's layers. One rank refuses them too,
/// so that programs do not depend on the number of ranks.
void PartsFrame::refuse_approximations(const Camera& camera) {
  const Transparency method = frame_.transparency.method;
  if (method == Transparency::exact || method == Transparency::none ||
      (asked_ & kColorTargets) == 0 || !finds_layers(camera, Transparency::exact))
    return;
  phase("check layers", [&] {
    throw Error(Errc::unsupported,
                "a picture of several ranks: translucent surfaces are blended exactly; draw with "
                "Transparency::exact or none");
  });
}

/// The option, or a quarter of the renderer's memory limit if that is less.
std::uint64_t PartsFrame::most_fragment_bytes() const {
  const std::uint64_t limit = renderer_.options().memory_limit;
  return limit == 0 ? options_.fragment_bytes : std::min(options_.fragment_bytes, limit / 4);
}

/// Draws everything in one pass, hoping that the fragments fit. The limit is divided by three:
/// fragments are held by block and packed, and a rank's share of all, which it blends, may be as
/// large again.
void PartsFrame::hold_fragments(const Camera& camera) {
  FragmentRoom room;
  if (!surface_.empty())
    room = [layers = shared_layers()](std::size_t n) { return layers.room(n); };
  held_.emplace(*grid_, band_, PlacesOfKeys{*own_, places_, 0}, keys_of_sink(),
                most_fragment_bytes() / 3, std::move(room));
  translucent_ = draw_own(camera, untoned(), *held_, shadows_).visibility == "layers";
  if (!translucent_) held_.reset();
  if (held_ && !surface_.empty()) shared_layers().tell(own_rank(), *held_);
}

void PartsFrame::begin_picture() {
  locally("begin picture", [&] {
    if (!is_root()) return;
    raster::FrameRequest request;
    request.width = frame_.width;
    request.height = frame_.height;
    request.samples = frame_.samples;
    request.isa = choose_isa(renderer_.options().isa);
    request.background = frame_.background;
    request.linear_light = linear_light_;
    request.targets = in_place(targets_of(filled_, kColorTargets), band_.y0);
    picture_.emplace(*grid_, request, RendererAccess::threads(renderer_));
  });
}

void PartsFrame::finish_picture() {
  locally("store colours", [&] {
    if (picture_) picture_->finish();
  });
}

void PartsFrame::layers(const Camera& camera) {
  linear_light_ = frame_.shader == Shader::material;
  if (!in_bands_) share_layers();
  if (in_bands_ && frame_.shader != Shader::id)
    locally("count again", [&] {
      held_.reset();
      if (translucent_) (void)draw_survey(camera);
    });
  begin_picture();
  if (any_keys_ || in_bands_) {
    const Words::Won won = meet();
    note(won);
    FrameOptions over_nothing = untoned();
    over_nothing.background = {};
    shade(camera, over_nothing, behind_target(frame_.shader), won.blocks);
    gather_behind(won.blocks);
    ask_what_hides(won);
  }
  if (in_bands_) {
    draw_bands(camera);
  } else {
    blend_held();
  }
  finish_picture();
}

SharedLayers PartsFrame::shared_layers() const {
  return {surface_.subspan(words_of_surface_), grid_->count(), ranks_.size()};
}

/// After the agreement on sizes: finds out whether all fragments fit into shared memory.
void PartsFrame::share_layers() {
  if (surface_.empty()) return;
  const std::uint64_t size = words_of_surface_ + shared_layers().size();
  if (size > most_shared_) return;
  // A quarter more, so that a slightly fuller later frame fits too.
  if (size > surface_.size()) {
    std::span<std::uint64_t> more = ranks_.share(std::min(size + size / 4, most_shared_));
    if (more.empty()) more = ranks_.share(size);
    if (!more.empty()) {
      // share() may have moved the memory.
      const std::span<std::uint64_t> before = std::exchange(surface_, more);
      if (held_)
        held_->has_moved(reinterpret_cast<std::uintptr_t>(before.data()), before.size_bytes(),
                         reinterpret_cast<std::uintptr_t>(surface_.data()));
    }
  }
  shares_layers_ = size <= surface_.size();
}

void PartsFrame::blend_on_shared() {
  const bool into_picture = ranks_.is_one_process();
  std::optional<SharedLayers::OpenPicture> open;
  phase("lay fragments", [&] {
    if (picture_ && into_picture) open.emplace(shared_layers(), *picture_);
    if (held_) {
      stats_.fragments += held_->leave_out(hides());
      shared_layers().lay(own_rank(), *held_);
    }
    held_.reset();
  });
  if (into_picture)
    return phase("blend", [&] {
      const SharedLayers::Visit visit(shared_layers());
      layer_merge().blend(*grid_, shared_layers(), RendererAccess::threads(renderer_),
                          visit.picture());
    });
  phase("blend", [&] {
    // The root does this while other ranks blend.
    if (picture_) picture_->store_rest(shared_layers());
    layer_merge().blend(*grid_, shared_layers(), RendererAccess::threads(renderer_), nullptr);
  });
  locally("take layers", [&] {
    if (picture_) picture_->take_seen(shared_layers());
  });
}

LayerMerge PartsFrame::layer_merge() const {
  return {choose_isa(renderer_.options().isa), 1 - frame_.transparency.alpha_threshold,
          frame_.samples};
}

void PartsFrame::blend_held() {
  ++stats_.bands;
  if (shares_layers_) return blend_on_shared();
  blend_fragments(packed("pack fragments", [&](Mail& fragments) {
    if (held_) {
      stats_.fragments += held_->leave_out(hides());
      held_->pack(fragments);
    }
    held_.reset();
  }));
}

void PartsFrame::draw_bands(const Camera& camera) {
  const std::vector<Rect> bands = plan_bands();
  stats_.bands += bands.size();
  for (const Rect& band : bands) {
    rows_done_ = std::max(rows_done_, band.y0);
    blend_fragments(
        packed("draw layers", [&](Mail& fragments) { draw_band(camera, band, fragments); }));
  }
}

void PartsFrame::blend_fragments(Mail fragments) {
  exchange(fragments, "make room for fragments");
  const Mail seen = sent_to_root("blend", "make room for layers", [&](Bytes& to) {
    layer_merge().blend(*grid_, fragments, RendererAccess::threads(renderer_), to);
    fragments = Mail(0);
  });
  locally("take layers", [&] {
    if (picture_) picture_->take_seen(seen);
  });
}

void PartsFrame::gather_behind(std::span<const BlockMask> won) {
  const Mail mail =
      sent_to_root("pack what is behind", "make room for what is behind", [&](Bytes& to) {
        send_pixels(won, *pixels_, to);
        pixels_.reset();
      });
  locally("take what is behind", [&] {
    if (!is_root()) return;
    for (std::size_t r = 0; r < mail.ranks(); ++r) picture_->take_behind(mail.from(r));
  });
}

/// Finds the nearest opaque words of all ranks where this rank has fragments.
void PartsFrame::ask_what_hides(const Words::Won& won) {
  if (surface_.empty()) return ask_owners_what_hides(won.own);
  locally("look what hides", [&] {
    note_asks();
    for (const BlockMask& b : asks_) {
      answers_.push_back(hides_.size());
      grid_->each_pixel(b, [&](int i, int, int) {
        hides_.push_back(won.all[b.block * kPixels + static_cast<std::size_t>(i)]);
      });
    }
  });
}

void PartsFrame::note_asks() {
  const auto ask = [&](BlockMask b) {
    if (b.mask != 0) asks_.push_back(b);
  };
  if (held_) held_->each_block(ask);
  if (!survey_) return;
  const auto masks = survey_->masks();
  for (std::size_t b = 0; b < masks.size(); ++b) ask({masks[b], static_cast<std::uint32_t>(b)});
}

void PartsFrame::ask_owners_what_hides(const std::vector<std::uint64_t>& own_words) {
  Mail asked = packed("ask what hides", [&](Mail& mail) {
    note_asks();
    for (const BlockMask& b : asks_) put_mask(mail.to(grid_->owner(b.block)), b);
  });
  exchange(asked, "make room for questions");
  Mail answers = packed("say what hides", [&](Mail& mail) {
    const std::uint64_t first = grid_->firsts()[own_rank()];
    for (std::size_t r = 0; r < asked.ranks(); ++r)
      for (Reader from = asked.from(r); !from.at_end();) {
        const BlockMask b = from.take_mask();
        grid_->each_pixel(b, [&](int i, int, int) {
          put(mail.to(r), own_words[(b.block - first) * kPixels + static_cast<std::size_t>(i)]);
        });
      }
  });
  exchange(answers, "make room for what hides");
  locally("take what hides", [&] {
    // Owners have rising runs of blocks, so their answers come in the order of the asks.
    for (std::size_t r = 0; r < answers.ranks(); ++r)
      for (Reader from = answers.from(r); !from.at_end();)
        hides_.push_back(from.take<std::uint64_t>());
    std::size_t at = 0;
    for (const BlockMask& b : asks_) {
      answers_.push_back(at);
      grid_->each_pixel(b, [&](int, int, int) { ++at; });
    }
  });
}

/// All ranks plan the same bands, from counts that the root broadcasts.
std::vector<Rect> PartsFrame::plan_bands() {
  const int columns = (frame_.width + kBinSize - 1) / kBinSize;
  const int rows = (band_.y1 - band_.y0 + kBinSize - 1) / kBinSize;
  std::vector<BinFragments> bins;
  const Mail mail = sent_to_root("count fragments", "make room for counts", [&](Bytes& to) {
    bins.resize(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
    if (!survey_) return;
    constexpr int kBlocks = kBinSize / kSide;
    std::vector<std::uint64_t> counts(bins.size());
    for (std::size_t b = 0; b < grid_->count(); ++b) {
      const int bx = static_cast<int>(b) % grid_->columns() / kBlocks;
      const int by = static_cast<int>(b) / grid_->columns() / kBlocks;
      counts[static_cast<std::size_t>(by * columns + bx)] += survey_->count(b);
    }
    for (std::size_t bin = 0; bin < bins.size(); ++bin) {
      if (counts[bin] == 0) continue;
      put(to, static_cast<std::uint32_t>(bin));
      put(to, counts[bin]);
    }
  });
  phase("add counts", [&] {
    for (std::size_t r = 0; r < mail.ranks(); ++r)
      for (Reader from = mail.from(r); !from.at_end();) {
        BinFragments& bin = bins[from.take<std::uint32_t>()];
        const auto count = from.take<std::uint64_t>();
        bin.all += count;
        bin.most = std::max(bin.most, count);
      }
  });
  ranks_.broadcast(std::as_writable_bytes(std::span(bins)), options_.root);
  const std::uint64_t bytes = ~ranks_.max(~most_fragment_bytes());
  std::vector<Rect> bands;
  phase("plan bands", [&] {
    bands = bands_of(frame_.width, band_.y1 - band_.y0, bins, mail.ranks(), bytes);
    for (Rect& band : bands) {
      band.y0 += band_.y0;
      band.y1 += band_.y0;
    }
  });
  return bands;
}

/// For a pass of own parts from `first` on, in a band: for each pixel with fragments, the key
/// behind which none of them is visible. If the opaque surface there is another rank's, earlier
/// parts in the list are in front of it at equal depth.
Image<std::uint64_t> PartsFrame::keys_that_hide(Rect band, std::size_t first) const {
  Image<std::uint64_t> keys(band.x1 - band.x0, band.y1 - band.y0);
  std::ranges::fill(keys.pixels(), kNearest);
  const auto columns = static_cast<std::uint32_t>(grid_->columns());
  const auto begin_of = [&](int y) {
    return std::ranges::lower_bound(
        asks_, static_cast<std::uint32_t>((y - grid_->top()) / kSide) * columns, {},
        &BlockMask::block);
  };
  const std::uint64_t base = first_id_of(first), lowest = own_->first_ids[first];
  const auto end = begin_of(band.y1 + kSide - 1);
  for (auto ask = begin_of(band.y0); ask != end; ++ask) {
    std::size_t at = answers_[static_cast<std::size_t>(ask - asks_.begin())];
    grid_->each_pixel(*ask, [&](int i, int x, int y) {
      const std::uint64_t word = hides_[at++];
      if (x < band.x0 || x >= band.x1) return;
      std::uint64_t& key = keys(x - band.x0, y - band.y0);
      key = 0;
      if (word == 0) return;
      const std::uint64_t place = raster::id_of_key(word);
      const auto part =
          static_cast<std::size_t>(std::ranges::lower_bound(places_, place) - places_.begin());
      const bool is_own = part < places_.size() && places_[part] == place;
      const std::uint64_t id =
          is_own ? raster::id_of_key(keys_.of(ask->block)[i]) : own_->first_ids[part];
      // May lie outside the pass's ids, but stays in range: on either side there are at least as
      // many ids of all ranks as own ones.
      const std::uint64_t of_pass = base + id - lowest;
      key = (word & ~raster::kIdMask) | (raster::kIdMask - of_pass);
    });
  }
  return keys;
}

void PartsFrame::draw_band(const Camera& camera, Rect band, Mail& mail) {
  if (!survey_) return;
  for (std::size_t first = 0, last = 0; first < places_.size(); first = last) {
    last = end_of_run(first);
    Image<std::uint64_t> keys;
    const std::uint64_t from_pass = own_->first_ids[first] - first_id_of(first);
    FragmentBytes fragments(*grid_, band, {*own_, places_, from_pass});
    Targets held;
    Pass pass{.first_id = first_id_of(first)};
    if (frame_.samples == 1) {
      keys = keys_that_hide(band, first);
      held.keys = raster::placed(keys.view(), band);
      pass.load = true;
    }
    (void)RendererAccess::render(renderer_, own_scene(first, last), camera, untoned(), held, pass,
                                 {.sink = &fragments, .part = band, .shadows = shadows_});
    stats_.fragments += fragments.leave_out({});
    fragments.pack(mail);
  }
}

}  // namespace rastrum::ranks
