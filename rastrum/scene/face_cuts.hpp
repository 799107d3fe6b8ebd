// Faces of more than three corners as triangles, for readers and for arrays.
//
// A face has n − 2 triangles, all turned as it is. The fan of its first corner is right where none
// of its triangles turns against the face, seen along its Newell normal: always where the face is
// convex. Others are cut ear by ear (Meisters, "Polygons have ears", 1975) in the plane across that
// normal. What deviates: an ear waits until what lies in it is gone, so no corner is asked in vain,
// and only inward corners are looked at, by a grid (Held, FIST, 2001).
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

/// Whether a quad is cut from its second corner to its fourth: the fan of the first is wrong, and
/// this is right.
[[nodiscard]] bool is_cut_across(const Vec3d (&corner)[4]);

/// Cuts faces, one after the other; keeps its scratch.
///
/// Corners that are the same place, or lie in a row, are no trouble. A face that crosses itself, or
/// has no area, has some n − 2 triangles of its corners. In float64, so the same on every machine.
/// About O(corners); O(corners²) where inward corners crowd in one place of a large face.
class FaceCutter {
 public:
  /// What it keeps for each corner of the largest face, about.
  static constexpr std::size_t kScratch = 112;

  /// Three places in `corners` a triangle, ascending; empty: the fan of the first corner. Valid
  /// until the next call.
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
  /// A corner that waits for another one.
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
  std::vector<double> x_, y_;  ///< across the normal, which points to the eye
  std::vector<std::uint32_t> before_, after_;
  std::vector<std::uint32_t> stamp_;  ///< what is older in a queue is no longer true
  std::vector<std::uint8_t> inward_;  ///< or straight; false of what is cut off
  std::vector<std::uint8_t> in_grid_;
  /// The first inward corner of each cell; a row has one cell more, which is never empty. From an
  /// empty cell it is some cells to the next that is not.
  std::vector<std::uint32_t> cell_, next_in_cell_, to_filled_;
  std::vector<std::uint32_t> first_waiting_;  ///< for each corner
  std::vector<Waiting> waiting_;
  std::vector<Entry> queue_, straight_;
  std::size_t columns_ = 1, rows_ = 1;
  double x0_ = 0, y0_ = 0, per_unit_x_ = 0, per_unit_y_ = 0;
};

/// The positions of corners begin to end of a mesh, in `to`; none where an index is out of range.
[[nodiscard]] std::span<const Vec3d> corners_of(const MeshView& mesh, std::size_t begin,
                                                std::size_t end, std::vector<Vec3d>& to);

/// The faces of a mesh of polygons that are no fans, so that a frame asks for each but once.
class FaceCuts {
 public:
  /// Requires valid faces; one with an index out of range is a fan. `threads`: null: one.
  explicit FaceCuts(const MeshView& mesh, parallel::Threads* threads = nullptr);

  static constexpr std::size_t kNone = ~std::size_t{0};
  /// The first of its faces that is not before `face`.
  [[nodiscard]] std::size_t lower_bound(std::size_t face) const;
  /// Its number here; kNone: a fan.
  [[nodiscard]] std::size_t find(std::size_t face) const;
  /// That of the mesh; kNone behind the last.
  [[nodiscard]] std::size_t face(std::size_t i) const {
    return i < faces_.size() ? faces_[i] : kNone;
  }
  /// As FaceCutter::cut.
  [[nodiscard]] const std::uint32_t* triangles(std::size_t i) const {
    return triangles_.data() + first_[i];
  }

 private:
  std::vector<std::size_t> faces_, first_;
  std::vector<std::uint32_t> triangles_;
};

/// `mesh` with the cuts of its faces, kept in `cuts`, where it is of polygons and has none yet: for
/// who asks for many of its triangles.
[[nodiscard]] MeshView with_cuts(const MeshView& mesh, std::list<FaceCuts>& cuts,
                                 parallel::Threads* threads = nullptr);

}  // namespace rastrum
