#include <rastrum/raster/draws/over_picture.hpp>

#include <bit>

#include <rastrum/raster/setup/make_piece.hpp>

namespace rastrum::raster {

OverPicture::OverPicture(ImageView<const float> depth, std::span<const Draw> draws,
                         const FragmentTest* inner)
    : depth_(depth), given_(draws), draws_(draws.begin(), draws.end()), inner_(inner) {
  for (Draw& draw : draws_) draw.flags |= kTested;
}

std::uint64_t OverPicture::test(const FrameGeometry& frame, const Piece& piece, const Block& block,
                                const ShadingPoints* points) const noexcept {
  Block nearer = block;
  for (std::uint64_t m = block.mask; m != 0; m &= m - 1) {
    const int i = std::countr_zero(m);
    const int x = block.bx * kBlockSize + i % kBlockSize;
    const int y = block.by * kBlockSize + i / kBlockSize;
    const float behind = depth_(x, y);
    // What has depth 0 is drawn where nothing is.
    if (behind > 0 && !(depth_at(piece, x, y) > behind)) nearer.mask ^= std::uint64_t{1} << i;
  }
  if (inner_ == nullptr || nearer.mask == 0) return nearer.mask;
  const std::uint64_t id = id_of_key(piece.low);
  const Draw& draw = frame.draw_of(id);
  const Draw& given = given_[static_cast<std::size_t>(&draw - frame.draws.data())];
  if ((given.flags_of(id - draw.first_id) & kTested) == 0) return nearer.mask;
  return inner_->test(frame, piece, nearer, points);
}

}  // namespace rastrum::raster
