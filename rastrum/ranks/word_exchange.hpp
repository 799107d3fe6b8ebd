// The opaque phase: words of depth and part meet at the owner of each pixel by maximum, and owners
// tell each rank which pixels it has won.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <rastrum/ranks/agree.hpp>
#include <rastrum/ranks/blocks.hpp>
#include <rastrum/ranks/part_list.hpp>

namespace rastrum::ranks {

/// Depth above the inverted place of a part in the list of all, as a visibility key has an id: the
/// maximum is the nearest surface, of equal ones that of the part which one renderer draws first. A
/// rank has one word a pixel, that of its greatest key, since its ids rise with its parts.
class Words {
 public:
  /// Words from the rank's keys; `places` are its parts' in `list`.
  Words(const BlockGrid& grid, ImageView<const std::uint64_t> keys, const OwnParts& own,
        std::span<const std::size_t> places);

  struct Won {
    std::vector<BlockMask> blocks;
    WordExchange taken{};
    std::uint64_t words = 0;         ///< that this rank had
    std::vector<std::uint64_t> own;  ///< the greatest words of all ranks in the blocks it owns
  };
  [[nodiscard]] Won meet(Communicator& ranks, const AtPhase& at, const PartList& list,
                         WordExchange wanted);

 private:
  void send_sparse(Mail& mail) const;
  void take_sparse(const Mail& mail, std::size_t rank, std::vector<std::uint64_t>& own) const;
  [[nodiscard]] std::uint64_t mask_of(std::size_t block) const;

  const BlockGrid& grid_;
  std::vector<std::uint64_t> words_;  ///< 64 a block
};

}  // namespace rastrum::ranks
