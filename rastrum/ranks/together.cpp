// SPDX-License-Identifier: BSD-3-Clause
#include <cstring>
#include <optional>

#include <rastrum/ranks.hpp>
#include <rastrum/ranks/agree.hpp>
#include <rastrum/ranks/blocks.hpp>
#include <rastrum/ranks/hops.hpp>

namespace rastrum {

void do_alike(Communicator& ranks, std::string_view phase, FunctionRef<void()> f) {
  rastrum::ranks::in_phase(ranks, {}, phase, f);
}

std::vector<std::vector<std::byte>> gather_to_all(Communicator& ranks,
                                                  std::span<const std::byte> bytes) {
  std::optional<rastrum::ranks::Mail> mail;
  do_alike(ranks, "pack for all", [&] {
    mail.emplace(ranks.size());
    for (std::size_t r = 0; r < mail->ranks(); ++r) mail->to(r).assign(bytes.begin(), bytes.end());
  });
  rastrum::ranks::exchange_with_all(ranks, {}, *mail, "make room for all");
  std::vector<std::vector<std::byte>> all;
  do_alike(ranks, "take of all", [&] {
    for (std::size_t r = 0; r < mail->ranks(); ++r) {
      rastrum::ranks::Reader from = mail->from(r);
      const auto all_of = from.take_all();
      all.emplace_back(all_of.begin(), all_of.end());
    }
  });
  return all;
}

std::vector<double> FitOfRanks::gather(std::span<const double> numbers) {
  std::vector<double> all;
  for (const auto& bytes : gather_to_all(ranks_, std::as_bytes(numbers))) {
    all.resize(all.size() + numbers.size());
    std::memcpy(all.data() + all.size() - numbers.size(), bytes.data(), bytes.size());
  }
  return all;
}

}  // namespace rastrum
