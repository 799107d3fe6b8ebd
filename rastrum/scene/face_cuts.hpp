// SPDX-License-Identifier: BSD-3-Clause
// Triangulates faces of more than three corners, for readers and for arrays. A face has n − 2
// triangles, which turn as it does. The first corner's fan is taken if none of its triangles turns
// against the face, seen along its Newell normal, as in every convex face. Others are cut ear by
// ear (Meisters, "Polygons have ears", 1975) in the plane across that normal. Deviations: a corner
// whose ear contains another waits until that is gone, and a grid finds the inward corners in an
// ear (Held, FIST, 2001).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <list>
#include <span>
#include <utility>
#include <vector>

#include <rastrum/mesh.hpp>
#include <rastrum/vec.hpp>

namespace rastrum {

namespace parallel {
class Threads;
}

/// Whether a quad is cut from its second corner to its fourth, because only this fan passes.
[[nodiscard]] bool is_cut_across(const Vec3d (&corner)[4]);

/// Cuts faces and keeps its scratch. Corners may repeat or be collinear. A face that crosses itself
/// or has no area gets n − 2 triangles that may overlap. Float64 makes all machines agree. About
/// O(corners); O(corners²) if inward corners of a large face crowd in one place.
class FaceCutter {
 public:
  /// About the bytes of scratch per corner of the largest face.
  static constexpr std::size_t kScratch = 112;

  /// Three places in `corners` per triangle, ascending; empty: the first corner's fan. Valid until
  /// the next call.
  [[nodiscard]] std::span<const std::uint32_t> cut(std::span<const Vec3d> corners);

  /// Calls f(i, j, k) for each triangle of a face of n corners, whose position is at(corner).
  template <class At, class F>
  void for_each_triangle(std::size_t n, const At& at, const F& f) {
    std::span<const std::uint32_t> triangles;
    if (n > 3) {
      corners_.resize(n);
      for (std::size_t i = 0; i < n; ++i) corners_[i] = at(i);
      triangles = cut(corners_);
    }
    for (std::size_t t = 0; t < triangles.size(); t += 3)
      f(std::size_t{triangles[t]}, std::size_t{triangles[t + 1]}, std::size_t{triangles[t + 2]});
    if (triangles.empty())
      for (std::size_t k = 2; k < n; ++k) f(std::size_t{0}, k - 1, k);
  }

 private:
  struct Entry {
    std::uint32_t corner, stamp;
  };
  struct Waiting {
    Entry entry;
    std::uint32_t next;
  };

  void flatten(std::span<const Vec3d> corners, const Vec3d& normal);
  void make_grid();
  [[nodiscard]] double area(std::uint32_t a, std::uint32_t b, std::uint32_t c) const;
  [[nodiscard]] std::size_t column(double x) const;
  [[nodiscard]] std::size_t row(double y) const;
  [[nodiscard]] std::pair<std::size_t, std::size_t> columns_in(
      std::size_t row_number, const std::array<std::uint32_t, 3>& triangle) const;
  [[nodiscard]] std::uint32_t* filled(std::uint32_t* cell);
  [[nodiscard]] std::uint32_t what_lies_in(std::uint32_t corner);
  [[nodiscard]] bool lies_in(std::uint32_t corner, std::uint32_t a, std::uint32_t b,
                             std::uint32_t c) const;
  void set_inward(std::uint32_t corner);
  void cut_off(std::uint32_t corner);
  void cut_ears(std::size_t n);

  std::vector<Vec3d> corners_;
  std::vector<std::uint32_t> triangles_;
  std::vector<double> x_, y_;  ///< in the plane across the normal, which points to the viewer
  std::vector<std::uint32_t> before_, after_;
  std::vector<std::uint32_t> stamp_;  ///< entries with an older stamp are void
  std::vector<std::uint8_t> inward_;  ///< or straight; 0 once cut off
  std::vector<std::uint8_t> in_grid_;
  /// cell_: the first inward corner of each cell; an extra cell per row ends searches. to_filled_:
  /// for an empty cell, a distance to a later one.
  std::vector<std::uint32_t> cell_, next_in_cell_, to_filled_;
  std::vector<std::uint32_t> first_waiting_;  ///< by corner: the first that waits for it
  std::vector<Waiting> waiting_;
  std::vector<Entry> queue_, straight_;
  std::size_t columns_ = 1, rows_ = 1;
  double x0_ = 0, y0_ = 0, per_unit_x_ = 0, per_unit_y_ = 0;
};

/// The positions of corners begin to end of a mesh, in `to`; empty if an index is out of range.
[[nodiscard]] std::span<const Vec3d> corners_of(const MeshView& mesh, std::size_t begin,
                                                std::size_t end, std::vector<Vec3d>& to);

/// The faces of a polygon mesh that are no fans; a frame cuts each once.
class FaceCuts {
 public:
  /// Requires valid faces; a face with an index out of range is a fan. `threads`: null: one thread.
  explicit FaceCuts(const MeshView& mesh, parallel::Threads* threads = nullptr);

  static constexpr std::size_t kNone = ~std::size_t{0};
  /// The number here of the first such face at or after `face`.
  [[nodiscard]] std::size_t lower_bound(std::size_t face) const;
  /// The number of `face` here; kNone: it is a fan.
  [[nodiscard]] std::size_t find(std::size_t face) const;
  /// The mesh's number of face `i` here; kNone after the last.
  [[nodiscard]] std::size_t face(std::size_t i) const {
    return i < faces_.size() ? faces_[i] : kNone;
  }
  /// As FaceCutter::cut returns them.
  [[nodiscard]] const std::uint32_t* triangles(std::size_t i) const {
    return triangles_.data() + first_[i];
  }

 private:
  std::vector<std::size_t> faces_, first_;
  std::vector<std::uint32_t> triangles_;
};

/// `mesh` with its polygons cut, unless it has cuts, for reading many triangles. Keeps the cuts in
/// `cuts`.
[[nodiscard]] MeshView with_cuts(const MeshView& mesh, std::list<FaceCuts>& cuts,
                                 parallel::Threads* threads = nullptr);

}  // namespace rastrum
