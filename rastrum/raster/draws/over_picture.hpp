// Drawing into a picture that is there already (Targets::over): its depth is a fragment test, so
// that every coverage and every visibility, layers too, heed it before they resolve a pixel.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <rastrum/raster/draws/geometry.hpp>

namespace rastrum::raster {

/// Keeps the fragments that are nearer than a picture, and of those what another test keeps.
class OverPicture final : public FragmentTest {
 public:
  /// `depth`: the picture's, reversed, 0 where nothing is; read for a pixel before it is written.
  /// `inner` (null: none) tests what the flags of `draws` say. All outlive this.
  OverPicture(ImageView<const float> depth, std::span<const Draw> draws, const FragmentTest* inner);

  /// The draws, all of them tested.
  [[nodiscard]] std::span<Draw> draws() { return draws_; }
  /// What it was given.
  [[nodiscard]] std::span<const Draw> given() const { return given_; }
  [[nodiscard]] const FragmentTest* inner() const { return inner_; }

  [[nodiscard]] std::uint64_t test(const FrameGeometry& frame, const Piece& piece,
                                   const Block& block,
                                   const ShadingPoints* points) const noexcept override;

 private:
  ImageView<const float> depth_;
  std::span<const Draw> given_;
  std::vector<Draw> draws_;
  const FragmentTest* inner_;
};

}  // namespace rastrum::raster
