// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/ranks/word_exchange.hpp>

#include <algorithm>
#include <array>
#include <atomic>
#include <optional>

#include <rastrum/parallel/mask.hpp>
#include <rastrum/raster/rules/piece.hpp>

namespace rastrum::ranks {

Words::Words(const BlockGrid& grid, const SparseBlocks& keys, const OwnParts& own,
             std::span<const std::size_t> places)
    : grid_(grid), words_(grid.count()) {
  std::size_t instance = 0;
  std::array<std::uint64_t, kPixels> words{};
  for (std::size_t b = 0; b < grid.count(); ++b) {
    const std::uint64_t mask = keys.mask(b);
    if (mask == 0) continue;
    const std::uint64_t* const of = keys.of(b);
    for (std::uint64_t m = mask; m != 0; m &= m - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(m));
      const std::uint64_t key = of[i], id = raster::id_of_key(key);
      if (id < own.first_ids[instance] || id >= own.first_ids[instance + 1])
        instance = own.instance_of(id);
      words[i] = (key & ~raster::kIdMask) | (raster::kIdMask - places[instance]);
    }
    words_.set(b, words.data(), mask);
  }
}

WordExchange Words::choose(Communicator& ranks) const {
  const auto n = static_cast<std::size_t>(ranks.size());
  if (n < kLeastForHops) return WordExchange::sparse;
  std::uint64_t bytes = 0, receivers = 0;  // of blocks that others own
  for (std::size_t r = 0; r < n; ++r) {
    if (r == static_cast<std::size_t>(ranks.rank())) continue;
    const std::uint64_t before = bytes;
    for (std::uint64_t b = grid_.firsts()[r]; b < grid_.firsts()[r + 1]; ++b)
      if (const std::uint64_t mask = words_.mask(b); mask != 0)
        bytes += kMaskBytes +
                 sizeof(std::uint64_t) * static_cast<std::uint64_t>(parallel::popcount(mask));
    receivers += bytes != before ? 1 : 0;
  }
  return hops_cost_less(ranks, bytes, receivers) ? WordExchange::two_hops : WordExchange::sparse;
}

void Words::put_owned(const SparseBlocks& words, std::size_t owner, Bytes& to) const {
  for (std::uint64_t b = grid_.firsts()[owner]; b < grid_.firsts()[owner + 1]; ++b)
    if (const std::uint64_t mask = words.mask(b); mask != 0)
      put_words(to, {mask, static_cast<std::uint32_t>(b)}, words.of(b));
}

void Words::take(const Mail& mail, std::size_t rank, std::vector<std::uint64_t>& own) const {
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

/// Each rank sends along its row what goes to a column; the receiver keeps the greatest words of
/// its row and sends them along the column.
void Words::meet_by_hops(Communicator& ranks, const AtPhase& at,
                         std::vector<std::uint64_t>& own) const {
  const auto me = static_cast<std::size_t>(ranks.rank());
  std::optional<HopGrid> hops;
  std::optional<Mail> mail;
  std::vector<std::size_t> first_to, first_from, column;
  in_phase(ranks, at, "pack words of the first hop", [&] {
    own.resize((grid_.firsts()[me + 1] - grid_.firsts()[me]) * kPixels);
    hops.emplace(static_cast<std::size_t>(ranks.size()));
    mail.emplace(ranks.size());
    first_to = hops->first_to(me);
    first_from = hops->first_from(me);
    column = hops->second(me);
    for (std::size_t r = 0; r < mail->ranks(); ++r)
      put_owned(words_, r, mail->to(hops->via(me, r)));
  });
  exchange_among(ranks, at, *mail, first_to, first_from, "make room for words");
  in_phase(ranks, at, "merge words", [&] {
    SparseBlocks merged(grid_.count());
    for (const std::size_t r : first_from)
      for (Reader from = mail->from(r); !from.at_end();) {
        const BlockMask drawn = from.take_mask();
        merged.raise(drawn,
                     from.take_bytes(sizeof(std::uint64_t) *
                                     static_cast<std::size_t>(parallel::popcount(drawn.mask))));
      }
    mail.emplace(ranks.size());
    for (const std::size_t r : column) put_owned(merged, r, mail->to(r));
  });
  exchange_among(ranks, at, *mail, column, column, "make room for merged words");
  in_phase(ranks, at, "take words", [&] { take(*mail, me, own); });
}

void Words::clear_own(const BlockGrid& grid, std::size_t rank, std::span<std::uint64_t> surface) {
  const auto firsts = grid.firsts();
  std::ranges::fill(
      surface.subspan(firsts[rank] * kPixels, (firsts[rank + 1] - firsts[rank]) * kPixels), 0);
}

void Words::raise(std::span<std::uint64_t> surface) const {
  // Must hold between processes too: one that dies holds no lock.
  static_assert(std::atomic_ref<std::uint64_t>::is_always_lock_free);
  for (std::size_t b = 0; b < words_.count(); ++b) {
    const std::uint64_t mask = words_.mask(b);
    if (mask == 0) continue;
    const std::uint64_t* const words = words_.of(b);
    for (std::uint64_t m = mask; m != 0; m &= m - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(m));
      const std::atomic_ref<std::uint64_t> word(surface[b * kPixels + i]);
      std::uint64_t there = word.load(std::memory_order_relaxed);
      while (there < words[i] &&
             !word.compare_exchange_weak(there, words[i], std::memory_order_relaxed)) {
      }
    }
  }
}

Words::Won Words::look(std::span<const std::uint64_t> surface, bool with_blocks) const {
  Won won;
  won.taken = WordExchange::shared;
  won.words = words_.pixels();
  won.all = surface;
  for (std::size_t b = 0; with_blocks && b < words_.count(); ++b) {
    if (words_.mask(b) == 0) continue;
    const std::uint64_t* const words = words_.of(b);
    std::uint64_t mask = 0;
    for (std::size_t i = 0; i < kPixels; ++i)
      mask |= std::uint64_t{words[i] == surface[b * kPixels + i]} << i;
    mask &= words_.mask(b);
    if (mask != 0) won.blocks.push_back({mask, static_cast<std::uint32_t>(b)});
  }
  return won;
}

Words::Won Words::meet_owners(Communicator& ranks, const AtPhase& at, WordExchange wanted) const {
  const auto me = static_cast<std::size_t>(ranks.rank());
  Won won;
  std::vector<std::uint64_t>& own = won.own;
  won.words = words_.pixels();
  won.taken = wanted;
  if (wanted == WordExchange::automatic || wanted == WordExchange::shared)
    won.taken = choose(ranks);
  if (won.taken == WordExchange::two_hops) {
    meet_by_hops(ranks, at, own);
    return won;
  }
  Mail mail(ranks.size());
  in_phase(ranks, at, "pack words", [&] {
    own.resize((grid_.firsts()[me + 1] - grid_.firsts()[me]) * kPixels);
    for (std::size_t r = 0; r < mail.ranks(); ++r) put_owned(words_, r, mail.to(r));
  });
  exchange_with_all(ranks, at, mail, "make room for words");
  in_phase(ranks, at, "take words", [&] { take(mail, me, own); });
  return won;
}

Words::Won Words::meet(Communicator& ranks, const AtPhase& at, const PartList& list,
                       WordExchange wanted) const {
  const auto me = static_cast<std::size_t>(ranks.rank());
  Won won = meet_owners(ranks, at, wanted);
  Mail answers(ranks.size());
  in_phase(ranks, at, "say who has won", [&] {
    const std::vector<std::uint64_t>& own = won.own;
    std::vector<std::uint64_t> masks(answers.ranks());
    std::vector<std::size_t> winners;  // of the block
    for (std::size_t b = 0; b * kPixels < own.size(); ++b) {
      for (std::size_t i = 0; i < kPixels; ++i) {
        const std::uint64_t word = own[b * kPixels + i];
        if (word == 0) continue;
        const auto r = static_cast<std::size_t>(list.parts()[raster::id_of_key(word)].rank);
        if (masks[r] == 0) winners.push_back(r);
        masks[r] |= std::uint64_t{1} << i;
      }
      for (const std::size_t r : winners) {
        put_mask(answers.to(r), {masks[r], static_cast<std::uint32_t>(grid_.firsts()[me] + b)});
        masks[r] = 0;
      }
      winners.clear();
    }
  });
  const auto exchange = won.taken == WordExchange::two_hops ? exchange_by_hops : exchange_with_all;
  exchange(ranks, at, answers, "make room for answers");
  in_phase(ranks, at, "take answers", [&] {
    for (std::size_t r = 0; r < answers.ranks(); ++r)
      for (Reader from = answers.from(r); !from.at_end();) won.blocks.push_back(from.take_mask());
  });
  return won;
}

}  // namespace rastrum::ranks
