// SPDX-License-Identifier: BSD-3-Clause
// The common part of large files with vertices and indexed triangles of one size each.
#pragma once

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <rastrum/io/large_file.hpp>

namespace rastrum::io {

struct IndexedPlace {
  std::uint64_t triangles = 0, vertices = 0;
  std::size_t first_vertex = 0, vertex_bytes = 0;
  std::size_t position = 0;  ///< in a vertex: three numbers
  bool wide = false;         ///< float64
  bool far = false;          ///< and stays so, by the reader's rule; else rounded
  std::size_t first_face = 0, face_bytes = 0;
  std::string name{};  ///< before messages about it; empty: the file has one mesh
  /// Skipped faces before this triangle; `bytes` counts all skipped faces up to here.
  struct Gap {
    std::uint64_t triangle = 0;
    std::size_t bytes = 0;
  };
  std::vector<Gap> gaps{};

  [[nodiscard]] std::size_t vertex_at(std::uint64_t v) const {
    return first_vertex + v * vertex_bytes;
  }
  [[nodiscard]] std::size_t face_at(std::uint64_t t) const {
    const auto after = std::ranges::upper_bound(gaps, t, {}, &Gap::triangle);
    return first_face + t * face_bytes + (after == gaps.begin() ? 0 : std::prev(after)->bytes);
  }
  /// How many of the `n` triangles from `t` on are contiguous.
  [[nodiscard]] std::size_t side_by_side(std::uint64_t t, std::size_t n) const {
    const auto after = std::ranges::upper_bound(gaps, t, {}, &Gap::triangle);
    return after == gaps.end() ? n : std::min<std::size_t>(n, after->triangle - t);
  }
};

class LargeIndexed : public LargeFile {
 public:
  void read(std::uint64_t first, std::size_t count, std::size_t most_bytes,
            FileChunk& chunk) const override;
  [[nodiscard]] std::size_t position_runs(parallel::Threads& threads) const override;
  [[nodiscard]] std::size_t part_of_run(std::size_t run) const override;
  [[nodiscard]] std::optional<FileBox> run_box(std::size_t run) const override;
  [[nodiscard]] std::optional<FileBox> box(std::uint64_t first, std::uint64_t count) const override;
  [[nodiscard]] float longest_edge(std::uint64_t first, std::uint64_t count) const override;

 protected:
  static constexpr std::size_t kAtOnce = 1 << 14;

  explicit LargeIndexed(const std::filesystem::path& file) : LargeFile(file) {}
  /// Copies the indices of triangles [first, first + n), and widens the range to hold them. Throws
  /// as read().
  virtual void copy_indices(const IndexedPlace& mesh, std::uint64_t first, std::size_t n,
                            std::uint32_t* to, std::uint32_t& lowest,
                            std::uint32_t& highest) const = 0;
  [[noreturn]] void refuse_index(const IndexedPlace& mesh, std::uint64_t triangle,
                                 std::uint32_t index) const {
    fail(mesh.name + "triangle " + std::to_string(triangle) + " refers to vertex " +
         vertex_text(index) + ", but " + (mesh.name.empty() ? "the file" : "it") + " has " +
         std::to_string(mesh.vertices));
  }
  [[nodiscard]] std::size_t part_at(std::uint64_t triangle) const;
  [[nodiscard]] std::size_t mesh_of(std::size_t part) const {
    return mesh_of_part_.empty() ? 0 : mesh_of_part_[part];
  }

  std::vector<IndexedPlace> meshes_;
  std::vector<std::size_t> mesh_of_part_{};  ///< empty: all are of the first mesh

 private:
  [[nodiscard]] Vec3d position_at(const IndexedPlace& mesh, std::uint64_t v) const;
  template <class P>
  void gather(const IndexedPlace& mesh, std::uint32_t lowest, std::uint32_t highest,
              FileChunk& chunk, std::vector<P>& to) const;
  [[nodiscard]] std::pair<std::size_t, std::size_t> place_of_run(std::size_t run) const override;
  void read_run(std::size_t run,
                const std::function<void(std::span<const Vec3d>)>& f) const override;
  void keep_boxes(std::vector<FileBox> boxes) const override;
  /// The run of a mesh's vertices for a run of positions.
  [[nodiscard]] std::size_t run_of_mesh(std::size_t run) const;
  void look_for_boxes(parallel::Threads& threads) const;
  [[nodiscard]] static std::size_t runs_of(const IndexedPlace& mesh) {
    return static_cast<std::size_t>((mesh.vertices + kAtOnce - 1) / kAtOnce);
  }
  [[nodiscard]] std::pair<std::size_t, std::size_t> place_in_mesh(std::size_t mesh_number,
                                                                  std::size_t run) const;
  void read_in_mesh(std::size_t mesh_number, std::size_t run,
                    const std::function<void(std::span<const Vec3d>)>& f) const;

  /// The lowest and highest vertex of kAtOnce triangles, and an upper bound of their edges.
  struct Range {
    std::uint32_t lowest = ~std::uint32_t{0}, highest = 0;
    float longest_edge = 0;  ///< infinity: vertices too far apart to look at
    void add(const Range& r) {
      lowest = std::min(lowest, r.lowest);
      highest = std::max(highest, r.highest);
      longest_edge = std::max(longest_edge, r.longest_edge);
    }
  };
  /// The range of triangles [first, first + count) of one part, and of some beside them.
  [[nodiscard]] Range range_of(std::size_t part, std::uint64_t first, std::uint64_t count) const;
  struct Look {
    VertexSet used;
    std::vector<Range> ranges;
  };
  [[nodiscard]] float longest_of(const IndexedPlace& mesh,
                                 std::span<const std::uint32_t> corners) const;
  [[nodiscard]] Look look_at(const IndexedPlace& mesh, parallel::Threads& threads) const;

  mutable std::mutex looking_;
  mutable std::vector<Look> looks_;             ///< by mesh; empty before the first look
  mutable std::vector<std::size_t> first_run_;  ///< by part, of kAtOnce vertices each
  /// The first run of each mesh, of kAtOnce vertices each: nodes share them.
  mutable std::vector<std::size_t> first_of_mesh_;
  mutable std::vector<FileBox> boxes_;  ///< per run, of vertices in use; empty until all were read
};

}  // namespace rastrum::io
