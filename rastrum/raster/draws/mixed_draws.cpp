#include <rastrum/raster/draws/mixed_draws.hpp>

#include <algorithm>
#include <bit>
#include <string>

#include <rastrum/core/error.hpp>

namespace rastrum::raster {

MixedDraws::MixedDraws(std::span<Draw> draws, const BlockShader* shader, const FragmentTest* test)
    : draws_(draws), shader_(shader), other_test_(test), test_(test) {
  if (draws.empty()) return;
  const auto shader_of = [&](const Draw& d) { return d.shader != nullptr ? d.shader : shader; };
  for (std::size_t i = 0; i < draws.size(); ++i)
    if (shader_of(draws[i]) == nullptr)
      throw Error(Errc::invalid_argument,
                  std::string("draw ")
                      .append(std::to_string(i))
                      .append(" has no shader; set Draw::shader, or give draw() one"));
  const auto same_fields = [&](const Draw& d) { return d.shader == draws.front().shader; };
  if (!std::ranges::all_of(draws, same_fields)) {
    own_draws_.assign(draws.begin(), draws.end());
    for (Draw& d : own_draws_) d.shader = shader_of(d);
    draws_ = own_draws_;
  }
  shader_ = shader_of(draws.front());
  for (const Draw& d : draws_)
    if (shader_of(d) != shader_) {
      shader_ = this;
      break;
    }

  // Draws that are not tested have no say.
  bool any = false;
  for (const Draw& d : draws_) {
    if ((d.any_flags() & kTested) == 0) continue;
    const FragmentTest* const own = d.test != nullptr ? d.test : other_test_;
    if (any && own != test_) {
      test_ = this;
      break;
    }
    test_ = own;
    any = true;
  }
  if (shader_ != this) return;
  for (const Draw& d : draws_) {
    if (!scratch_of_.try_emplace(d.shader, scratch_bytes_).second) continue;
    scratch_bytes_ += (d.shader->scratch_bytes() + 63) / 64 * 64;
    extra_count_ = std::max(extra_count_, d.shader->extra_count());
  }
}

/// Outputs that the shader does not have are 0.
bool MixedDraws::shade_part(const FrameGeometry& frame, const VisibleBlock& part,
                            const BlockShader& shader, Isa isa,
                            BlockColors& colors) const noexcept {
  VisibleBlock own = part;
  own.scratch = static_cast<std::byte*>(part.scratch) + scratch_of_.find(&shader)->second;
  if (shader.extra_count() == 0) own.extra = nullptr;
  if (part.extra != nullptr)
    for (std::size_t k = shader.extra_count(); k < extra_count_; ++k)
      for (std::uint64_t m = part.covered; m != 0; m &= m - 1)
        part.extra[k].set(std::countr_zero(m), {});
  return shader.shade(frame, own, isa, colors);
}

bool MixedDraws::shade(const FrameGeometry& frame, const VisibleBlock& block, Isa isa,
                       BlockColors& colors) const noexcept {
  const BlockShader* of[64];
  const Draw* draw = nullptr;
  for (std::uint64_t m = block.covered; m != 0; m &= m - 1) {
    const int i = std::countr_zero(m);
    const std::uint64_t id = id_of_key(block.keys[i]);
    if (draw == nullptr || id - draw->first_id >= draw->primitive_count) draw = &frame.draw_of(id);
    of[i] = draw->shader;
  }
  bool opaque = true;
  for (std::uint64_t left = block.covered; left != 0;) {
    VisibleBlock part = block;
    part.covered = 0;
    const BlockShader& shader = *of[std::countr_zero(left)];
    for (std::uint64_t m = left; m != 0; m &= m - 1) {
      const int i = std::countr_zero(m);
      part.covered |= std::uint64_t{of[i] == &shader} << i;
    }
    left &= ~part.covered;
    if (part.covered == block.covered) return shade_part(frame, part, shader, isa, colors);
    // What a shader is not asked for it may set to anything.
    BlockColors own, extra[kMaxExtraTargets];
    if (block.extra != nullptr) part.extra = extra;
    if (shade_part(frame, part, shader, isa, own)) std::fill_n(own.a, 64, 1.0F);
    for (std::uint64_t m = part.covered; m != 0; m &= m - 1) {
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
  frame.draw_of(id).shader->prefetch(frame, id);
}

std::optional<float> MixedDraws::alpha() const noexcept {
  const std::optional<float> first = draws_.front().shader->alpha();
  for (const auto& [shader, scratch] : scratch_of_)
    if (shader->alpha() != first) return std::nullopt;
  return first;
}

std::uint64_t MixedDraws::test(const FrameGeometry& frame, const Piece& piece, const Block& block,
                               const ShadingPoints* points) const noexcept {
  const Draw& draw = frame.draw_of(id_of_key(piece.low));
  const FragmentTest* const own = draw.test != nullptr ? draw.test : other_test_;
  return own == nullptr ? block.mask : own->test(frame, piece, block, points);
}

}  // namespace rastrum::raster
