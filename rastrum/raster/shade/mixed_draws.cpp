// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/raster/shade/mixed_draws.hpp>

#include <algorithm>
#include <bit>
#include <string>
#include <unordered_map>

#include <rastrum/error.hpp>
#include <rastrum/raster/shade/shader.hpp>

namespace rastrum::raster {

MixedDraws::MixedDraws(std::span<Draw> draws, const Shading& shading, const Testing& test)
    : draws_(draws), shading_(shading), test_(test) {
  if (draws.empty()) return;
  const auto shading_of = [&](const Draw& d) -> const Shading& {
    return d.shading ? d.shading : shading;
  };
  const auto test_of = [&](const Draw& d) -> const Testing& { return d.test ? d.test : test; };
  for (std::size_t i = 0; i < draws.size(); ++i)
    if (!shading_of(draws[i]))
      throw Error(Errc::invalid_argument,
                  std::string("draw ")
                      .append(std::to_string(i))
                      .append(" has no program; make draws by Program::draw"));
  shading_ = shading_of(draws.front());
  const bool mixes_shadings =
      std::ranges::any_of(draws, [&](const Draw& d) { return shading_of(d) != shading_; });
  // Draws whose fragments are not tested do not count.
  bool mixes_tests = false;
  const Testing* first = nullptr;
  for (const Draw& d : draws) {
    if ((d.any_flags() & kTested) == 0) continue;
    if (first == nullptr) first = &test_of(d);
    mixes_tests |= test_of(d) != *first;
  }
  if (first != nullptr) test_ = *first;
  if (mixes_tests) test_ = this;

  // Draws are numbered within their shading, so either all carry the given one or none does.
  if (mixes_shadings || mixes_tests ||
      std::ranges::any_of(draws, [&](const Draw& d) { return d.shading != draws[0].shading; })) {
    own_draws_.assign(draws.begin(), draws.end());
    for (Draw& d : own_draws_) {
      d.shading = shading_of(d);
      d.test = test_of(d);
    }
    draws_ = own_draws_;
  }
  if (!mixes_shadings) return;
  shading_ = this;
  std::unordered_map<Shading, std::uint32_t, Shading::Hash> numbers;
  for (const Draw& d : draws_) {
    const auto [at, is_new] =
        numbers.try_emplace(d.shading, static_cast<std::uint32_t>(parts_.size()));
    part_of_draw_.push_back(at->second);
    if (!is_new) continue;
    parts_.push_back({d.shading, scratch_bytes_});
    scratch_bytes_ += (raster::scratch_bytes(d.shading) + 63) / 64 * 64;
    extra_count_ = std::max(extra_count_, raster::extra_count(d.shading));
  }
}

/// Outputs that the shader lacks are 0.
bool MixedDraws::shade_part(const FrameGeometry& frame, const VisibleBlock& block, const Part& part,
                            Isa isa, BlockColors& colors) const noexcept {
  const std::size_t extra_count = raster::extra_count(part.shading);
  VisibleBlock own = block;
  own.scratch = static_cast<std::byte*>(block.scratch) + part.scratch;
  if (extra_count == 0) own.extra = nullptr;
  if (block.extra != nullptr)
    for (std::size_t k = extra_count; k < extra_count_; ++k)
      for (std::uint64_t m = block.covered; m != 0; m &= m - 1)
        block.extra[k].set(std::countr_zero(m), {});
  return shade_block(part.shading, frame, own, isa, colors);
}

bool MixedDraws::shade(const FrameGeometry& frame, const VisibleBlock& block, Isa isa,
                       BlockColors& colors) const noexcept {
  const Part* of[64];
  const Draw* draw = nullptr;
  for (std::uint64_t m = block.covered; m != 0; m &= m - 1) {
    const int i = std::countr_zero(m);
    const std::uint64_t id = id_of_key(block.keys[i]);
    if (draw == nullptr || id - draw->first_id >= draw->primitive_count) draw = &frame.draw_of(id);
    of[i] = &part_of(frame, *draw);
  }
  bool opaque = true;
  for (std::uint64_t left = block.covered; left != 0;) {
    VisibleBlock some = block;
    some.covered = 0;
    const Part& part = *of[std::countr_zero(left)];
    for (std::uint64_t m = left; m != 0; m &= m - 1) {
      const int i = std::countr_zero(m);
      some.covered |= std::uint64_t{of[i] == &part} << i;
    }
    left &= ~some.covered;
    if (some.covered == block.covered) return shade_part(frame, some, part, isa, colors);
    // A shader may write anything to other pixels, so it gets arrays of its own.
    BlockColors own, extra[kMaxExtraTargets];
    if (block.extra != nullptr) some.extra = extra;
    if (shade_part(frame, some, part, isa, own)) std::fill_n(own.a, 64, 1.0F);
    for (std::uint64_t m = some.covered; m != 0; m &= m - 1) {
      const int i = std::countr_zero(m);
      opaque &= colors.set(i, {own.r[i], own.g[i], own.b[i], own.a[i]});
      if (block.extra == nullptr) continue;
      for (std::size_t k = 0; k < extra_count_; ++k)
        block.extra[k].set(i, {extra[k].r[i], extra[k].g[i], extra[k].b[i], extra[k].a[i]});
    }
  }
  return opaque;
}

void MixedDraws::prefetch(const FrameGeometry& frame, std::uint64_t id) const noexcept {
  raster::prefetch(part_of(frame, frame.draw_of(id)).shading, frame, id);
}

std::optional<float> MixedDraws::alpha() const noexcept {
  const std::optional<float> first = constant_alpha(parts_.front().shading);
  for (const Part& part : parts_)
    if (constant_alpha(part.shading) != first) return std::nullopt;
  return first;
}

std::uint64_t MixedDraws::test(const FrameGeometry& frame, const Piece& piece, const Block& block,
                               const ShadingPoints* points) const noexcept {
  return test_block(frame.draw_of(id_of_key(piece.low)).test, frame, piece, block, points);
}

}  // namespace rastrum::raster
