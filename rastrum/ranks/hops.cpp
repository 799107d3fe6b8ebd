// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/ranks/hops.hpp>

#include <algorithm>
#include <optional>

namespace rastrum::ranks {
namespace {

/// A letter's header: sender, receiver, length.
constexpr std::size_t kLetterBytes = 2 * sizeof(std::uint32_t) + sizeof(std::uint64_t);

void put_letter(Bytes& to, std::uint32_t from, std::uint32_t whom,
                std::span<const std::byte> bytes) {
  put(to, from);
  put(to, whom);
  put(to, static_cast<std::uint64_t>(bytes.size()));
  to.insert(to.end(), bytes.begin(), bytes.end());
}

/// Calls f(from, to, bytes) for each letter received.
template <class F>
void each_letter(const Mail& mail, const std::vector<std::size_t>& senders, const F& f) {
  for (const std::size_t r : senders)
    for (Reader letters = mail.from(r); !letters.at_end();) {
      const auto from = letters.take<std::uint32_t>();
      const auto whom = letters.take<std::uint32_t>();
      const auto size = letters.take<std::uint64_t>();
      f(from, whom, letters.take_bytes(size));
    }
}

}  // namespace

HopGrid::HopGrid(std::size_t ranks) : ranks_(ranks), columns_(1) {
  while (columns_ * columns_ < ranks) ++columns_;
}

std::vector<std::size_t> HopGrid::first_to(std::size_t rank) const {
  std::vector<std::size_t> peers;
  for (std::size_t column = 0; column < columns_; ++column) peers.push_back(via(rank, column));
  return peers;
}

std::vector<std::size_t> HopGrid::first_from(std::size_t rank) const {
  std::vector<std::size_t> peers;
  const std::size_t row = rank / columns_ * columns_;
  for (std::size_t r = row; r < std::min(row + 2 * columns_, ranks_); ++r)
    if (via(r, rank) == rank) peers.push_back(r);
  return peers;
}

std::vector<std::size_t> HopGrid::second(std::size_t rank) const {
  std::vector<std::size_t> peers;
  for (std::size_t r = rank % columns_; r < ranks_; r += columns_) peers.push_back(r);
  return peers;
}

void exchange_with_all(Communicator& ranks, const AtPhase& at, Mail& mail, std::string_view room) {
  mail.exchange_sizes(ranks);
  in_phase(ranks, at, room, [&] { mail.make_room(); });
  mail.exchange(ranks);
}

void exchange_among(Communicator& ranks, const AtPhase& at, Mail& mail,
                    const std::vector<std::size_t>& to, const std::vector<std::size_t>& from,
                    std::string_view room) {
  mail.begin_sizes(to, from);
  mail.exchange(ranks);
  in_phase(ranks, at, room, [&] { mail.take_sizes(from); });
  mail.exchange(ranks);
}

void exchange_by_hops(Communicator& ranks, const AtPhase& at, Mail& mail, std::string_view room) {
  std::optional<HopGrid> grid;
  std::optional<Mail> first, second;
  const auto me = static_cast<std::size_t>(ranks.rank());
  std::vector<std::size_t> first_to, first_from, column;
  in_phase(ranks, at, "pack the first hop", [&] {
    grid.emplace(mail.ranks());
    first.emplace(ranks.size());
    first_to = grid->first_to(me);
    first_from = grid->first_from(me);
    column = grid->second(me);
    for (std::size_t r = 0; r < mail.ranks(); ++r)
      if (!mail.to(r).empty())
        put_letter(first->to(grid->via(me, r)), static_cast<std::uint32_t>(me),
                   static_cast<std::uint32_t>(r), mail.to(r));
  });
  exchange_among(ranks, at, *first, first_to, first_from, room);
  in_phase(ranks, at, "pack the second hop", [&] {
    second.emplace(ranks.size());
    each_letter(*first, first_from, [&](std::uint32_t from, std::uint32_t whom, auto bytes) {
      put_letter(second->to(whom), from, whom, bytes);
    });
    first.reset();
  });
  exchange_among(ranks, at, *second, column, column, room);
  in_phase(ranks, at, "open letters", [&] {
    mail.clear_from();
    each_letter(*second, column,
                [&](std::uint32_t from, std::uint32_t, auto bytes) { mail.set_from(from, bytes); });
  });
}

bool hops_cost_less(Communicator& ranks, std::uint64_t bytes, std::uint64_t receivers) {
  const auto n = static_cast<std::size_t>(ranks.size());
  // Every rank tells every other how much it sends.
  const std::uint64_t direct = ranks.max((n - 1 + receivers) * kBytesAMessage + bytes);
  const std::uint64_t hops =
      2 * HopGrid(n).messages() * kBytesAMessage + 2 * (bytes + receivers * kLetterBytes);
  return ranks.max(hops) < direct;
}

}  // namespace rastrum::ranks
