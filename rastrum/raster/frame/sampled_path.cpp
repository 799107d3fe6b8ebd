#include <rastrum/raster/frame/sampled_path.hpp>

#include <algorithm>

#include <rastrum/raster/cover/bin_keys.hpp>
#include <rastrum/raster/frame/bins.hpp>
#include <rastrum/raster/resolve/sampled_colors.hpp>

namespace rastrum::raster {
namespace {

/// The nearest surfaces of a bin, at each sample.
class NearestSamplesInBin {
 public:
  static constexpr bool kColors = true;

  explicit NearestSamplesInBin(MemoryAccount& memory) : planes_(memory) {}

  void begin(const BinContext& context, const SurfaceView& surface, Rect rect) {
    context_ = context;
    surface_ = surface;
    rect_ = rect;
    plane_ =
        static_cast<std::size_t>(surface.columns) * static_cast<std::size_t>(block_rows(rect)) * 64;
    const std::size_t keys = plane_ * static_cast<std::size_t>(context.request->samples);
    planes_.reserve(keys);
    std::fill_n(planes_.data(), keys, std::uint64_t{0});
  }
  void see(std::size_t sample) {
    SurfaceView plane = surface_;
    plane.keys = planes_.data() + sample * plane_;
    keys_.begin(*context_.kernel, plane, rect_, context_.request->targets.overdraw.empty());
  }
  void blocks(const Piece* pieces, std::span<Block> blocks) {
    if (!context_.request->has_tests()) return keys_.blocks(pieces, blocks);
    std::size_t kept = 0;
    for (Block block : blocks) {
      const Piece& piece = pieces[block.piece];
      if ((piece.flags & kMayDrop) != 0) block.mask = colors_.test(context_, piece, block);
      blocks[kept] = block;
      kept += block.mask != 0;
    }
    if (kept != 0) keys_.blocks(pieces, blocks.first(kept));
  }
  void fragments(std::span<const BinFragment> fragments) { keys_.fragments(fragments); }
  DepthBounds* bounds() { return keys_.bounds(); }
  void find_bounds() { keys_.find_bounds(); }
  void finish() {
    for (int by = rect_.y0 / kBlockSize; by * kBlockSize < rect_.y1; ++by)
      for (int bx = rect_.x0 / kBlockSize; bx * kBlockSize < rect_.x1; ++bx)
        colors_.resolve(context_, planes_.data() + surface_.index(bx, by) * 64, plane_, bx, by,
                        surface_.block(bx, by), *surface_.colors_of(bx, by));
  }
  void collect(Counters& counters) { keys_.collect(counters); }

 private:
  BinContext context_;
  SurfaceView surface_;
  Rect rect_;
  std::size_t plane_ = 0;
  ScratchBuffer<std::uint64_t> planes_;
  SampledColors colors_;
  BinKeys keys_;
};

class SampledPath final : public Method {
 public:
  explicit SampledPath(MemoryAccount& memory) : groups_(memory), bins_(memory) {}

  [[nodiscard]] Needs needs() const override {
    return {.rasterizer = "grouped",
            .visibility = "samples",
            .surface = false,
            .surface_bytes = 0,
            .colors = true,
            .triangle_bytes = 160,
            .expands = true,
            .quadrics = true,  // that is, round points
            .whole_view = true,
            .cuts_views = true};
  }

  void draw(Frame& frame, std::uint64_t first, std::uint64_t last) override {
    const bool hides = frame.request.targets.overdraw.empty();
    const BinTable lists{
        {frame.view, kBinSize}, hides, false, static_cast<std::size_t>(frame.request.samples)};
    const auto groups = groups_.set_up(frame, lists, true, first, last);
    frame.watch.lap(frame.stats, "setup and bin");
    frame.fits = groups.has_value();
    if (!frame.fits) return;
    frame.for_each_index(lists.bins.count(), [&](std::size_t bin) {
      bins_.draw(frame, lists, *groups, bin, lists.bins.rect(bin), kBinSize);
    });
    bins_.collect(frame.counters);
    frame.watch.lap(frame.stats, "draw and shade");
  }

  void abandon() override {
    Counters dropped;
    bins_.collect(dropped);
  }

 private:
  TriangleGroups groups_;
  Bins<NearestSamplesInBin> bins_;
};

}  // namespace

bool is_sampled(const FrameRequest& request) {
  return request.samples > 1 && !request.targets.over &&
         std::ranges::none_of(request.draws, [](const Draw& d) { return d.quadrics != nullptr; });
}

std::unique_ptr<Method> make_sampled_path(MemoryAccount& memory) {
  return std::make_unique<SampledPath>(memory);
}

}  // namespace rastrum::raster
