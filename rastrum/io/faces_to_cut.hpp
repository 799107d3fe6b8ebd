// SPDX-License-Identifier: BSD-3-Clause
// A file's faces as triangles. A face whose positions come later is a fan until everything is read.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <utility>
#include <vector>

#include <rastrum/io/reading.hpp>
#include <rastrum/scene/face_cuts.hpp>
#include <rastrum/vec.hpp>

namespace rastrum::io {

class FacesToCut {
 public:
  explicit FacesToCut(Budget& budget) : budget_(budget) {}
  /// Calls f(i, j, k) for each triangle of a face of n corners. vertex(corner) may be any integer.
  /// `at`: how many corners the triangles before it have.
  template <class Position, class Vertex, class F>
  void add(std::size_t n, const std::vector<Position>& positions, std::size_t at,
           const Vertex& vertex, const F& f) {
    if (n > largest_) budget_.take(n - std::exchange(largest_, n), FaceCutter::kScratch);
    bool known = true;
    for (std::size_t i = 0; n > 3 && i < n; ++i)
      known &= std::cmp_less(vertex(i), positions.size()) && std::cmp_greater_equal(vertex(i), 0);
    if (known)
      return cutter_.for_each_triangle(
          n, [&](std::size_t i) { return Vec3d(positions[static_cast<std::size_t>(vertex(i))]); },
          f);
    budget_.add(later_, {at, n});
    for (std::size_t k = 2; k < n; ++k) f(std::size_t{0}, k - 1, k);
  }
  /// Cuts the faces whose positions were unknown. `corners`: arrays of one number per corner, the
  /// indices of positions first; these must be in range.
  template <class Position>
  void finish(const std::vector<Position>& positions,
              std::initializer_list<std::vector<std::uint32_t>*> corners) {
    for (const Later& face : later_) {
      // Corner i in the fan: corners 0 and 1, then the last of each triangle.
      const auto place = [&](std::size_t i) { return face.at + (i < 2 ? i : 3 * (i - 1) - 1); };
      std::vector<std::size_t> places;
      const std::vector<std::uint32_t>& indices = **corners.begin();
      cutter_.for_each_triangle(
          face.corners, [&](std::size_t i) { return Vec3d(positions[indices[place(i)]]); },
          [&](std::size_t a, std::size_t b, std::size_t c) {
            places.insert(places.end(), {place(a), place(b), place(c)});
          });
      std::vector<std::uint32_t> cut(places.size());
      for (std::vector<std::uint32_t>* const array : corners) {
        for (std::size_t i = 0; i < places.size(); ++i) cut[i] = (*array)[places[i]];
        std::copy(cut.begin(), cut.end(), array->begin() + static_cast<std::ptrdiff_t>(face.at));
      }
    }
    later_.clear();
  }

 private:
  struct Later {
    std::size_t at, corners;
  };
  Budget& budget_;
  std::size_t largest_ = 3;  ///< of a face so far; triangles are not cut
  FaceCutter cutter_;
  std::vector<Later> later_;
};

}  // namespace rastrum::io
