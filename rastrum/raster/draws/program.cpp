// SPDX-License-Identifier: BSD-3-Clause
// A program's stages as hooks of the pipeline: finds fragments and their weights.
#include <rastrum/program.hpp>

#include <algorithm>
#include <bit>
#include <iterator>
#include <memory>

#include <rastrum/parallel/turn.hpp>
#include <rastrum/raster/draws/geometry.hpp>
#include <rastrum/raster/draws/hooks.hpp>
#include <rastrum/raster/draws/interpolate.hpp>
#include <rastrum/raster/rules/make_piece.hpp>

namespace rastrum::raster {
namespace {

/// The fragments of primitive `id` in `mask`, and their elements of the block.
class Batch {
 public:
  Batch(const FrameGeometry& frame, std::uint64_t id, std::uint64_t mask, int x0, int y0,
        const ShadingPoints* points)
      : topology_(frame.draw_of(id).topology) {
    FragmentLocator locator(frame);
    for (std::uint64_t m = mask; m != 0; m &= m - 1) {
      elements_[count_] = std::countr_zero(m);
      std::construct_at(fragments_ + count_, locator.locate(id, x0, y0, elements_[count_], points));
      ++count_;
    }
  }
  [[nodiscard]] std::span<Fragment> fragments() { return {fragments_, count_}; }
  [[nodiscard]] int element(std::size_t i) const { return elements_[i]; }
  [[nodiscard]] FragmentBatch view() const { return {topology_, {fragments_, count_}}; }

 private:
  Topology topology_;
  std::size_t count_ = 0;
  int elements_[64];
  union {
    Fragment fragments_[64];  // only fragments that exist are constructed
  };
};

}  // namespace

struct ProgramHooks final : VertexSource, BlockShader, FragmentTest {
  [[nodiscard]] static const ProgramHooks& of(const ProgramStages& stages) {
    return *stages.hooks_;
  }
  ProgramHooks(const ProgramStages& stages, std::size_t extra, bool has_test)
      : program(stages), extras(extra), discards(has_test) {}

  void project(std::size_t begin, std::size_t end, Viewport viewport, Isa,
               ProjectedVertex* out) const noexcept override {
    Vec4 clip[64];
    for (std::size_t i = begin; i < end; i += std::size(clip)) {
      const std::size_t n = std::min(end - i, std::size(clip));
      positions(i, n, clip);
      for (std::size_t k = 0; k < n; ++k) out[i - begin + k] = raster::project(clip[k], viewport);
    }
  }

  [[nodiscard]] Vec4d clip_position(std::size_t vertex) const noexcept override {
    Vec4 c;
    positions(vertex, 1, &c);
    return {c.x, c.y, c.z, c.w};
  }

  bool shade(const FrameGeometry& frame, const VisibleBlock& block, Isa,
             BlockColors& colors) const noexcept override {
    bool opaque = true;
    Vec4 shaded[64];
    Vec4 extra[kMaxExtraTargets][64];
    for (std::uint64_t left = block.covered; left != 0;) {
      const std::uint64_t low = block.keys[std::countr_zero(left)] & kIdMask;
      std::uint64_t mask = 0;
      for (std::uint64_t m = left; m != 0; m &= m - 1) {
        const int i = std::countr_zero(m);
        mask |= std::uint64_t{(block.keys[i] & kIdMask) == low} << i;
      }
      left &= ~mask;
      Batch batch(frame, id_of_key(low), mask, block.x0, block.y0, block.points);
      const std::span<Fragment> fragments = batch.fragments();
      for (std::size_t k = 0; k < fragments.size(); ++k)
        fragments[k].depth = std::bit_cast<float>(
            static_cast<std::uint32_t>(block.keys[batch.element(k)] >> kIdBits));
      const FragmentBatch view = batch.view();
      const bool is_shaded = parallel::CallingTurn::call(
          [&] { program.shade(view, shaded, block.extra == nullptr ? nullptr : extra); });
      if (!is_shaded) return false;
      for (std::size_t k = 0; k < fragments.size(); ++k) {
        const int i = batch.element(k);
        opaque &= colors.set(i, shaded[k]);
        if (block.extra != nullptr)
          for (std::size_t e = 0; e < extras; ++e) block.extra[e].set(i, extra[e][k]);
      }
    }
    return opaque;
  }

  [[nodiscard]] std::size_t extra_count() const noexcept override { return extras; }

  [[nodiscard]] std::uint64_t test(const FrameGeometry& frame, const Piece& piece,
                                   const Block& block,
                                   const ShadingPoints* points) const noexcept override {
    Batch batch(frame, id_of_key(piece.low), block.mask, block.bx * kBlockSize,
                block.by * kBlockSize, points);
    const std::span<Fragment> fragments = batch.fragments();
    for (Fragment& f : fragments) f.depth = depth_at(piece, f.x, f.y);
    std::uint64_t kept = block.mask;
    std::uint64_t holes = 0;
    const FragmentBatch view = batch.view();
    if (!parallel::CallingTurn::call([&] { holes = program.discarded(view); })) return 0;
    for (; holes != 0; holes &= holes - 1)
      kept &=
          ~(std::uint64_t{1} << batch.element(static_cast<std::size_t>(std::countr_zero(holes))));
    return kept;
  }

  /// If the program throws, the vertices lie behind the eye.
  void positions(std::size_t first, std::size_t count, Vec4* clip) const noexcept {
    const bool is_set = parallel::CallingTurn::call(
        [&] { program.positions(static_cast<std::uint32_t>(first), count, clip); });
    if (!is_set) std::fill_n(clip, count, Vec4{});
  }

  const ProgramStages& program;
  std::size_t extras;
  bool discards;
};

Shading::Shading(const ProgramStages& program) : colors_(&ProgramHooks::of(program)) {}
Testing::Testing(const ProgramStages& program) {
  if (const auto& hooks = ProgramHooks::of(program); hooks.discards) test_ = &hooks;
}
Draw::Draw(const ProgramDraw& draw) : Primitives(draw) {
  if (draw.program == nullptr) return;
  source = static_cast<const VertexSource*>(&ProgramHooks::of(*draw.program));
  shading = *draw.program;
  test = *draw.program;
}

}  // namespace rastrum::raster

namespace rastrum {

ProgramStages::ProgramStages(std::size_t extra_count, bool discards)
    : hooks_(std::make_unique<raster::ProgramHooks>(*this, extra_count, discards)) {}
ProgramStages::~ProgramStages() = default;

}  // namespace rastrum
