// SPDX-License-Identifier: BSD-3-Clause
// Frames whose draws have their own shading and fragment tests (Draw::shading, Draw::test). A frame
// takes one of each. MixedDraws is both, and gives each sample of a block to the shader or test of
// its draw.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <rastrum/raster/draws/geometry.hpp>
#include <rastrum/raster/draws/hooks.hpp>

namespace rastrum::raster {

class MixedDraws final : public BlockShader, public FragmentTest {
 public:
  /// `shading` and `test` are for draws without their own. The draws must outlive this. Throws
  /// Error{invalid_argument} naming a draw without a shader. O(draws).
  MixedDraws(std::span<Draw> draws, const Shading& shading, const Testing& test);

  /// The frame's draws, shading and test. This object is the shading or test only if draws differ
  /// in it.
  [[nodiscard]] std::span<Draw> draws() { return draws_; }
  [[nodiscard]] const Shading& shading() const { return shading_; }  ///< none: there are no draws
  [[nodiscard]] const Testing& test() const { return test_; }

  bool shade(const FrameGeometry& frame, const VisibleBlock& block, Isa isa,
             BlockColors& colors) const noexcept override;
  void prefetch(const FrameGeometry& frame, std::uint64_t id) const noexcept override;
  [[nodiscard]] std::optional<float> alpha() const noexcept override;
  [[nodiscard]] std::size_t scratch_bytes() const noexcept override { return scratch_bytes_; }
  [[nodiscard]] std::size_t extra_count() const noexcept override { return extra_count_; }

  [[nodiscard]] std::uint64_t test(const FrameGeometry& frame, const Piece& piece,
                                   const Block& block,
                                   const ShadingPoints* points) const noexcept override;

 private:
  struct Part {
    Shading shading;
    std::size_t scratch;  ///< where its part of the scratch begins, in bytes
  };
  [[nodiscard]] const Part& part_of(const FrameGeometry& frame, const Draw& draw) const {
    return parts_[part_of_draw_[static_cast<std::size_t>(&draw - frame.draws.data())]];
  }
  bool shade_part(const FrameGeometry& frame, const VisibleBlock& block, const Part& part, Isa isa,
                  BlockColors& colors) const noexcept;

  std::span<Draw> draws_;
  std::vector<Draw> own_draws_;  ///< copies with their shading and test, if draws differ in those
  Shading shading_;
  Testing test_;
  std::vector<Part> parts_;
  std::vector<std::uint32_t> part_of_draw_;
  std::size_t scratch_bytes_ = 0, extra_count_ = 0;
};

}  // namespace rastrum::raster
