// SPDX-License-Identifier: BSD-3-Clause
// Starts any peer where it is installed, and compares what it covers.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include <rastrum/error.hpp>
#include <rastrum/image.hpp>

namespace rastrum::bench {

/// A peer that could be started, or why not.
template <class P>
struct Started {
  std::optional<P> peer;
  std::string note;

  explicit operator bool() const { return peer.has_value(); }
  [[nodiscard]] std::string why_not() const { return peer ? "" : note; }
  P* operator->() { return &*peer; }
  /// For people.
  [[nodiscard]] std::string line() const { return (peer ? "peer: " : "left out: ") + note; }

  /// None, for this reason.
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

/// Share of the pixels that are equal.
template <class Ours, class T>
double equal_share(const Ours& ours, const Image<T>& theirs) {
  std::size_t equal = 0;
  for (int y = 0; y < theirs.height(); ++y)
    for (int x = 0; x < theirs.width(); ++x) equal += std::size_t{ours(x, y) == theirs(x, y)};
  return static_cast<double>(equal) / static_cast<double>(theirs.pixels().size());
}

/// Share of the pixels that either covers that both do.
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
