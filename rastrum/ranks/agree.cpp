// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/ranks/agree.hpp>

#include <algorithm>
#include <array>
#include <cstring>
#include <new>
#include <string>

#include <rastrum/core/number_text.hpp>
#include <rastrum/error.hpp>
#include <rastrum/stop.hpp>

namespace rastrum::ranks {
namespace {

constexpr std::int32_t kNoError = -1;  ///< an exception that is not an Error

/// The failing rank's message to all others, of fixed size.
struct Verdict {
  std::int32_t code = kNoError;  ///< Errc
  std::array<char, 1020> text{};
};

void set_text(Verdict& v, const char* text) {
  std::strncpy(v.text.data(), text, v.text.size() - 1);
}

Verdict verdict_of(const std::exception_ptr& failure) {
  Verdict v;
  try {
    std::rethrow_exception(failure);
  } catch (const Error& e) {
    v.code = static_cast<std::int32_t>(e.code());
    set_text(v, e.what());
  } catch (const std::bad_alloc&) {
    v.code = static_cast<std::int32_t>(Errc::out_of_memory);
    set_text(v, "no memory is left for the frame");
  } catch (const std::exception& e) {
    set_text(v, e.what());
  } catch (...) {
    set_text(v, "an exception that is not one of the standard library");
  }
  return v;
}

}  // namespace

void agree(Communicator& ranks, const std::exception_ptr& failure,
           std::span<std::uint64_t> numbers) {
  const auto size = static_cast<std::uint64_t>(ranks.size());
  const auto rank = static_cast<std::uint64_t>(ranks.rank());
  // The lowest failing rank has the greatest number; 0 means no failure.
  std::array<std::uint64_t, 1 + kMostNumbers> told{failure ? size - rank : 0};
  std::ranges::copy(numbers, told.begin() + 1);
  ranks.max_of_each(std::span(told).first(1 + numbers.size()));
  const std::uint64_t worst = told[0];
  if (worst == 0) {
    std::ranges::copy_n(told.begin() + 1, static_cast<std::ptrdiff_t>(numbers.size()),
                        numbers.begin());
    return;
  }
  const auto speaker = static_cast<int>(size - worst);
  Verdict v;
  if (speaker == ranks.rank()) v = verdict_of(failure);
  ranks.broadcast(std::as_writable_bytes(std::span(&v, 1)), speaker);
  if (v.code == static_cast<std::int32_t>(Errc::stopped)) throw Stopped{};
  const std::string message = text_of("rank ", speaker, ": ", v.text.data());
  if (v.code != kNoError) throw Error(static_cast<Errc>(v.code), message);
  throw std::runtime_error(message);
}

}  // namespace rastrum::ranks
