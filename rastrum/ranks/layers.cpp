// The colours of a frame with translucent surfaces. Opaque surfaces meet as words and are shaded by
// who has won; translucent fragments before them go to an owner of their block, which blends those
// of all ranks; the root lays what is seen over what is behind it, and that over the background.
#include <algorithm>
#include <cstring>
#include <string>
#include <utility>

#include <rastrum/device.hpp>
#include <rastrum/error.hpp>
#include <rastrum/ranks/bands.hpp>
#include <rastrum/ranks/parts_frame.hpp>
#include <rastrum/raster/kernels/kernels.hpp>
#include <rastrum/raster/resolve/resolve.hpp>

namespace rastrum::ranks {
namespace {

using raster::kBinSize;
using raster::Rect;

/// Opaque colours as blends want them: premultiplied, over nothing, in linear light for `material`.
/// Who is asked for that shades all of it so, as where something is translucent.
std::uint32_t behind_target(Shader shader) {
  return shader == Shader::material ? kLinearTarget : kColorTarget;
}

/// The image of them among a rank's own or the root's.
ImageView<Vec4> behind_of(const Targets& targets) {
  return targets.linear.empty() ? targets.color : targets.linear;
}

}  // namespace

void PartsFrame::check_method() const {
  if (frame_.transparency.method != Transparency::exact)
    throw Error(Errc::unsupported,
                "a picture of several ranks: translucent surfaces are blended exactly; draw with "
                "Transparency::exact or none");
}

void PartsFrame::layers(const Camera& camera) {
  linear_light_ = frame_.shader == Shader::material;
  phase("check layers", [&] { check_method(); });
  {
    Words::Won won = meet();
    note(won);
    FrameOptions over_nothing = frame_;
    over_nothing.tone = {};
    over_nothing.background = {};
    shade(camera, over_nothing, behind_target(frame_.shader), won.blocks);
    gather_behind(won.blocks);
    ask_what_hides(won.own);
  }
  draw_bands(camera);
  store_colors();
}

void PartsFrame::draw_bands(const Camera& camera) {
  const std::vector<Rect> bands = plan_bands();
  stats_.bands = bands.size();
  for (const Rect& band : bands) {
    std::optional<Mail> fragments, seen;
    phase("draw layers", [&] {
      fragments.emplace(ranks_.size());
      draw_band(camera, band, *fragments);
    });
    exchange(*fragments, "make room for fragments");
    phase("blend", [&] {
      seen.emplace(ranks_.size());
      LayerMerge merge(choose_isa(renderer_.options().isa), 1 - frame_.transparency.alpha_threshold,
                       frame_.samples);
      merge.blend(*fragments, [&](const SeenBlock& b) { put_seen(*grid_, b, seen->to(root())); });
      fragments.reset();
    });
    exchange(*seen, "make room for layers");
    phase("take layers", [&] {
      for (std::size_t r = 0; is_root() && r < seen->ranks(); ++r) take_seen_of(seen->from(r));
    });
  }
}

/// Lays what is seen over what is behind it, which with several samples is nothing any more.
void PartsFrame::take_seen_of(Reader from) {
  const auto& kernel = transparency::blend_kernels(choose_isa(renderer_.options().isa));
  while (!from.at_end()) {
    const SeenBlock block = take_seen(*grid_, from);
    if (frame_.samples > 1) {
      grid_->each_pixel(block.where,
                        [&](int i, int x, int y) { front_(x, y) = block.seen.at(i).color; });
    } else {
      raster::BlockColors behind{}, out;
      grid_->each_pixel(block.where, [&](int i, int x, int y) { behind.set(i, front_(x, y)); });
      kernel.finish(block.seen, behind, out);
      grid_->each_pixel(block.where, [&](int i, int x, int y) { front_(x, y) = out.at(i); });
    }
    covered_[block.where.block] |= block.where.mask;
  }
}

void PartsFrame::gather_behind(std::span<const BlockMask> won) {
  std::optional<Mail> mail;
  phase("pack what is behind", [&] {
    mail.emplace(ranks_.size());
    Bytes& to = mail->to(root());
    const ImageView<Vec4> behind = behind_of(images_->targets());
    for (const BlockMask& b : won) {
      put_mask(to, b);
      grid_->each_pixel(b, [&](int, int x, int y) { put(to, behind(x, y)); });
    }
    images_.reset();
  });
  exchange(*mail, "make room for what is behind");
  phase("take what is behind", [&] {
    if (!is_root()) return;
    front_ = Image<Vec4>(frame_.width, frame_.height);
    covered_.resize(grid_->count());
    for (std::size_t r = 0; r < mail->ranks(); ++r)
      for (Reader from = mail->from(r); !from.at_end();) {
        const BlockMask b = from.take_mask();
        grid_->each_pixel(b, [&](int, int x, int y) { front_(x, y) = from.take<Vec4>(); });
        covered_[b.block] |= b.mask;
      }
  });
}

/// The nearest opaque words of all ranks, where this rank has fragments.
void PartsFrame::ask_what_hides(const std::vector<std::uint64_t>& own_words) {
  std::optional<Mail> asked, answers;
  phase("ask what hides", [&] {
    asked.emplace(ranks_.size());
    answers.emplace(ranks_.size());
    if (!survey_) return;
    const auto masks = survey_->masks();
    for (std::size_t b = 0; b < masks.size(); ++b) {
      if (masks[b] == 0) continue;
      const auto block = static_cast<std::uint32_t>(b);
      asks_.push_back({masks[b], block});
      put_mask(asked->to(grid_->owner(block)), asks_.back());
    }
  });
  exchange(*asked, "make room for questions");
  phase("say what hides", [&] {
    const std::uint64_t first = grid_->firsts()[static_cast<std::size_t>(ranks_.rank())];
    for (std::size_t r = 0; r < asked->ranks(); ++r)
      for (Reader from = asked->from(r); !from.at_end();) {
        const BlockMask b = from.take_mask();
        grid_->each_pixel(b, [&](int i, int, int) {
          put(answers->to(r), own_words[(b.block - first) * kPixels + static_cast<std::size_t>(i)]);
        });
      }
  });
  exchange(*answers, "make room for what hides");
  phase("take what hides", [&] {
    // Owners have rising runs of blocks, so their answers together are in the order of the asks.
    for (std::size_t r = 0; r < answers->ranks(); ++r)
      for (Reader from = answers->from(r); !from.at_end();)
        hides_.push_back(from.take<std::uint64_t>());
    std::size_t at = 0;
    for (const BlockMask& b : asks_) {
      answers_.push_back(at);
      grid_->each_pixel(b, [&](int, int, int) { ++at; });
    }
  });
}

/// All ranks plan the same, from what the root has counted together.
std::vector<Rect> PartsFrame::plan_bands() {
  const int columns = (frame_.width + kBinSize - 1) / kBinSize;
  const int rows = (frame_.height + kBinSize - 1) / kBinSize;
  std::optional<Mail> mail;
  std::vector<BinFragments> bins;
  phase("count fragments", [&] {
    mail.emplace(ranks_.size());
    bins.resize(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
    if (!survey_) return;
    constexpr int kBlocks = kBinSize / kSide;
    const int block_columns = grid_->columns();
    const int block_rows = static_cast<int>(grid_->count()) / block_columns;
    for (std::size_t bin = 0; bin < bins.size(); ++bin) {
      const int bx = static_cast<int>(bin) % columns * kBlocks;
      const int by = static_cast<int>(bin) / columns * kBlocks;
      std::uint64_t count = 0;
      for (int y = by; y < std::min(by + kBlocks, block_rows); ++y)
        for (int x = bx; x < std::min(bx + kBlocks, block_columns); ++x)
          count += survey_->count(x, y);
      if (count == 0) continue;
      put(mail->to(root()), static_cast<std::uint32_t>(bin));
      put(mail->to(root()), count);
    }
  });
  exchange(*mail, "make room for counts");
  phase("add counts", [&] {
    for (std::size_t r = 0; r < mail->ranks(); ++r)
      for (Reader from = mail->from(r); !from.at_end();) {
        BinFragments& bin = bins[from.take<std::uint32_t>()];
        const auto count = from.take<std::uint64_t>();
        bin.all += count;
        bin.most = std::max(bin.most, count);
      }
  });
  ranks_.broadcast(std::as_writable_bytes(std::span(bins)), options_.root);
  std::uint64_t bytes = options_.fragment_bytes;
  if (const std::uint64_t limit = renderer_.options().memory_limit; limit != 0)
    bytes = std::min(bytes, limit / 4);
  bytes = ~ranks_.max(~bytes);
  std::vector<Rect> bands;
  phase("plan bands",
        [&] { bands = bands_of(frame_.width, frame_.height, bins, mail->ranks(), bytes); });
  return bands;
}

/// For a pass of own parts [first, last): of each pixel with fragments the key behind which nothing
/// of these is seen. Of an opaque surface of equal depth that is of another rank, those parts are
/// before it which come before its part.
Image<std::uint64_t> PartsFrame::keys_that_hide(Rect band, std::size_t first,
                                                std::size_t last) const {
  Image<std::uint64_t> keys(band.x1 - band.x0, band.y1 - band.y0);
  std::ranges::fill(keys.pixels(), kLost);
  const auto columns = static_cast<std::uint32_t>(grid_->columns());
  const auto begin_of = [&](int y) {
    return std::ranges::lower_bound(asks_, static_cast<std::uint32_t>(y / kSide) * columns, {},
                                    &BlockMask::block);
  };
  const std::uint64_t base = first_id_of(first), lowest = own_->first_ids[first];
  const auto end = begin_of(band.y1 + kSide - 1);
  for (auto ask = begin_of(band.y0); ask != end; ++ask) {
    std::size_t at = answers_[static_cast<std::size_t>(ask - asks_.begin())];
    grid_->each_pixel(*ask, [&](int, int x, int y) {
      const std::uint64_t word = hides_[at++];
      if (x < band.x0 || x >= band.x1) return;
      std::uint64_t& key = keys(x - band.x0, y - band.y0);
      key = 0;
      if (word == 0) return;
      const std::uint64_t place = raster::id_of_key(word);
      const auto part =
          static_cast<std::size_t>(std::ranges::lower_bound(places_, place) - places_.begin());
      const bool is_own = part < places_.size() && places_[part] == place;
      const std::uint64_t id = is_own ? raster::id_of_key(keys_(x, y)) : own_->first_ids[part];
      const std::uint64_t of_pass = base + std::clamp(id, lowest, own_->first_ids[last]) - lowest;
      key = (word & ~raster::kIdMask) | (raster::kIdMask - of_pass);
    });
  }
  return keys;
}

void PartsFrame::draw_band(const Camera& camera, Rect band, Mail& mail) {
  if (!survey_) return;
  FrameOptions alone = frame_;
  alone.tone = {};
  for (std::size_t first = 0, last = 0; first < places_.size(); first = last) {
    last = end_of_run(first);
    Image<std::uint64_t> keys;
    const std::uint64_t from_pass = own_->first_ids[first] - first_id_of(first);
    FragmentBytes fragments(grid_->columns(), band, [&](std::uint64_t key) {
      return std::uint64_t{places_[own_->instance_of(raster::id_of_key(key) + from_pass)]};
    });
    Targets load;
    if (frame_.samples == 1) {
      keys = keys_that_hide(band, first, last);
      load.keys = keys;
      load.load = true;
    }
    load.first_id = first_id_of(first);
    (void)RendererAccess::render(renderer_, own_scene(first, last), camera, alone, load,
                                 {.sink = &fragments, .part = band, .shadows = shadows_});
    stats_.fragments += fragments.pack(mail);
  }
}

/// The root's picture, by what a renderer writes from blended colours.
void PartsFrame::store_colors() {
  phase("store colours", [&] {
    if (!is_root()) return;
    raster::FrameRequest request;
    request.width = frame_.width;
    request.height = frame_.height;
    request.isa = choose_isa(renderer_.options().isa);
    request.background = frame_.background;
    request.linear_light = linear_light_;
    request.targets = targets_of(filled_, kColorTargets);
    const raster::Backdrop backdrop = raster::backdrop_of(request);
    for (std::size_t b = 0; b < grid_->count(); ++b) {
      const int x0 = static_cast<int>(b) % grid_->columns() * kSide;
      const int y0 = static_cast<int>(b) / grid_->columns() * kSide;
      alignas(64) std::uint64_t keys[kPixels] = {};
      raster::BlockColors colors{};
      grid_->each_pixel({covered_[b], static_cast<std::uint32_t>(b)}, [&](int i, int x, int y) {
        keys[i] = 1;
        colors.set(i, front_(x, y));
      });
      (void)raster::resolve_block(request, {}, backdrop, keys, x0, y0, nullptr, &colors);
    }
  });
}

}  // namespace rastrum::ranks
