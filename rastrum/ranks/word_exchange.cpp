#include <rastrum/ranks/word_exchange.hpp>

#include <algorithm>

#include <rastrum/raster/setup/piece.hpp>

namespace rastrum::ranks {

Words::Words(const BlockGrid& grid, ImageView<const std::uint64_t> keys, const OwnParts& own,
             std::span<const std::size_t> places)
    : grid_(grid), words_(grid.count() * kPixels) {
  std::size_t instance = 0;
  for (std::size_t b = 0; b < grid.count(); ++b)
    grid.each_pixel({~std::uint64_t{0}, static_cast<std::uint32_t>(b)}, [&](int i, int x, int y) {
      const std::uint64_t key = keys(x, y);
      if (key == 0) return;
      const std::uint64_t id = raster::id_of_key(key);
      if (id < own.first_ids[instance] || id >= own.first_ids[instance + 1])
        instance = own.instance_of(id);
      words_[b * kPixels + static_cast<std::size_t>(i)] =
          (key & ~raster::kIdMask) | (raster::kIdMask - places[instance]);
    });
}

std::uint64_t Words::mask_of(std::size_t block) const {
  std::uint64_t mask = 0;
  for (std::size_t i = 0; i < kPixels; ++i)
    mask |= std::uint64_t{words_[block * kPixels + i] != 0} << i;
  return mask;
}

void Words::send_sparse(Mail& mail) const {
  for (std::size_t r = 0; r < mail.ranks(); ++r)
    for (std::uint64_t b = grid_.firsts()[r]; b < grid_.firsts()[r + 1]; ++b) {
      const BlockMask drawn{mask_of(b), static_cast<std::uint32_t>(b)};
      if (drawn.mask == 0) continue;
      put_mask(mail.to(r), drawn);
      for (std::uint64_t m = drawn.mask; m != 0; m &= m - 1)
        put(mail.to(r), words_[b * kPixels + static_cast<std::size_t>(std::countr_zero(m))]);
    }
}

void Words::take_sparse(const Mail& mail, std::size_t rank, std::vector<std::uint64_t>& own) const {
  for (std::size_t r = 0; r < mail.ranks(); ++r)
    for (Reader from = mail.from(r); !from.at_end();) {
      const BlockMask drawn = from.take_mask();
      std::uint64_t* const at = own.data() + (drawn.block - grid_.firsts()[rank]) * kPixels;
      for (std::uint64_t m = drawn.mask; m != 0; m &= m - 1) {
        std::uint64_t& word = at[std::countr_zero(m)];
        word = std::max(word, from.take<std::uint64_t>());
      }
    }
}

Words::Won Words::meet(Communicator& ranks, const AtPhase& at, const PartList& list,
                       WordExchange wanted) {
  const auto me = static_cast<std::size_t>(ranks.rank());
  Won won;
  std::vector<std::uint64_t>& own = won.own;
  Mail mail(ranks.size()), answers(ranks.size());
  std::uint64_t most = 0;
  in_phase(ranks, at, "pack words", [&] {
    own.resize((grid_.firsts()[me + 1] - grid_.firsts()[me]) * kPixels);
    won.words = static_cast<std::uint64_t>(
        words_.size() - static_cast<std::size_t>(std::ranges::count(words_, std::uint64_t{0})));
    if (wanted == WordExchange::dense) return;
    send_sparse(mail);
    for (std::size_t r = 0; r < mail.ranks(); ++r) most += r == me ? 0 : mail.to(r).size();
  });
  // Dense sends all but a rank's own share. That rank decides which has most to send.
  const std::uint64_t dense_bytes =
      words_.size() * sizeof(std::uint64_t) / mail.ranks() * (mail.ranks() - 1);
  won.taken = wanted;
  if (wanted == WordExchange::automatic)
    won.taken = ranks.max(most) <= dense_bytes ? WordExchange::sparse : WordExchange::dense;
  if (won.taken == WordExchange::dense) {
    ranks.reduce_max(words_, grid_.first_words(), own);
  } else {
    mail.exchange_sizes(ranks);
    in_phase(ranks, at, "make room for words", [&] { mail.make_room(); });
    mail.exchange(ranks);
  }
  in_phase(ranks, at, "take words", [&] {
    if (won.taken == WordExchange::sparse) take_sparse(mail, me, own);
    std::vector<std::uint64_t> masks(answers.ranks());
    for (std::size_t b = 0; b * kPixels < own.size(); ++b) {
      for (std::size_t i = 0; i < kPixels; ++i)
        if (const std::uint64_t word = own[b * kPixels + i]; word != 0)
          masks[static_cast<std::size_t>(list.parts()[raster::id_of_key(word)].rank)] |=
              std::uint64_t{1} << i;
      for (std::size_t r = 0; r < masks.size(); ++r)
        if (masks[r] != 0)
          put_mask(answers.to(r), {masks[r], static_cast<std::uint32_t>(grid_.firsts()[me] + b)});
      std::ranges::fill(masks, 0);
    }
  });
  answers.exchange_sizes(ranks);
  in_phase(ranks, at, "make room for answers", [&] { answers.make_room(); });
  answers.exchange(ranks);
  in_phase(ranks, at, "take answers", [&] {
    for (std::size_t r = 0; r < answers.ranks(); ++r)
      for (Reader from = answers.from(r); !from.at_end();) won.blocks.push_back(from.take_mask());
  });
  return won;
}

}  // namespace rastrum::ranks
