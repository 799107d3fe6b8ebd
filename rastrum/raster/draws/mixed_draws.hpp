// Frames whose draws have shaders and fragment tests of their own (Draw::shader, Draw::test). What
// draws a frame knows one of each: here they are one, which hands the samples of a block on to the
// shader of the draw that each belongs to.
#pragma once

#include <cstddef>
#include <span>
#include <unordered_map>
#include <vector>

#include <rastrum/raster/draws/geometry.hpp>

namespace rastrum::raster {

class MixedDraws final : public BlockShader, public FragmentTest {
 public:
  /// `shader` and `test` (null: none) are those of draws without their own. All must outlive this.
  /// Throws Error{invalid_argument} naming a draw without a shader. O(draws).
  MixedDraws(std::span<Draw> draws, const BlockShader* shader, const FragmentTest* test);

  /// What the frame has: the given ones where all draws have the same.
  [[nodiscard]] std::span<Draw> draws() { return draws_; }
  [[nodiscard]] const BlockShader* shader() const { return shader_; }  ///< null: without draws
  [[nodiscard]] const FragmentTest* test() const { return test_; }

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
  bool shade_part(const FrameGeometry& frame, const VisibleBlock& part, const BlockShader& shader,
                  Isa isa, BlockColors& colors) const noexcept;

  std::span<Draw> draws_;
  std::vector<Draw> own_draws_;  ///< each with its shader, where they differ
  const BlockShader* shader_;
  const FragmentTest* other_test_;  ///< of draws without their own
  const FragmentTest* test_;
  std::unordered_map<const BlockShader*, std::size_t> scratch_of_;  ///< bytes before its scratch
  std::size_t scratch_bytes_ = 0, extra_count_ = 0;
};

}  // namespace rastrum::raster
