// SPDX-License-Identifier: BSD-3-Clause
// Starts a peer if it is installed, and compares its coverage.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include <rastrum/error.hpp>
#include <rastrum/image.hpp>

namespace rastrum::bench {

/// A started peer, or the reason why there is none.
template <class P>
struct Started {
  std::optional<P> peer;
  std::string note;

  explicit operator bool() const { return peer.has_value(); }
  [[nodiscard]] std::string why_not() const { return peer ? "" : note; }
  P* operator->() { return &*peer; }
  /// The note as a line of output.
  [[nodiscard]] std::string line() const { return (peer ? "peer: " : "left out: ") + note; }

  /// No peer, for this reason.
  explicit Started(const char* why) : note(why) {}
  explicit Started(int threads) {
    try {
      peer.emplace(threads);
      note = peer->description();
    } catch (const Error& e) {
      if (e.code() != Errc::no_device) throw;
      note = e.what();
    }
  }
};

template <class Ours, class T>
double equal_share(const Ours& ours, const Image<T>& theirs) {
  std::size_t equal = 0;
  for (int y = 0; y < theirs.height(); ++y)
    for (int x = 0; x < theirs.width(); ++x) equal += std::size_t{ours(x, y) == theirs(x, y)};
  return static_cast<double>(equal) / static_cast<double>(theirs.pixels().size());
}

/// The share of the pixels that both cover among those that either covers.
inline double common_coverage(const Image<Rgba8>& ours, const Image<Vec4>& theirs) {
  std::size_t either = 0, both = 0;
  for (int y = 0; y < ours.height(); ++y)
    for (int x = 0; x < ours.width(); ++x) {
      const bool a = ours(x, y).a != 0, b = theirs(x, y).w != 0;
      either += a || b;
      both += a && b;
    }
  return either == 0 ? 1 : static_cast<double>(both) / static_cast<double>(either);
}

}  // namespace rastrum::bench
