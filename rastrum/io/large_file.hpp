// SPDX-License-Identifier: BSD-3-Clause
// Mesh files that are mapped, not read. Triangles come in runs, in place where they lie as the
// renderer has them. A selection becomes a small file of the same kind for the ordinary reader
// (docs/large_files.md).
#pragma once

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <iterator>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <rastrum/array.hpp>
#include <rastrum/core/vectors.hpp>
#include <rastrum/io/mapped_file.hpp>
#include <rastrum/io/parse.hpp>
#include <rastrum/io/wide_positions.hpp>
#include <rastrum/vec.hpp>

namespace rastrum::parallel {
class Threads;
}

namespace rastrum::io {

/// A run of a file's triangles: indices into positions or, without them, positions in order. Copies
/// keep their memory from run to run.
struct FileChunk {
  std::uint64_t first = 0;
  std::size_t count = 0;
  ArrayView<Vec3> positions{};
  IndexView indices{};

  std::vector<std::uint32_t> copied_indices{};
  std::vector<Vec3> copied_positions{};
  std::vector<Vec3d> copied_wide_positions{};
  /// The file's bytes that hold `positions`; none if they were copied.
  std::size_t mapped_offset = 0, mapped_bytes = 0;
};

/// Consecutive triangles that are one instance of the scene: a mesh at a node.
struct FilePart {
  std::uint64_t first = 0, count = 0;
};

/// A small file of some triangles of a large one, with all its parts.
struct FileSelection {
  struct Part {
    std::uint64_t id = 0;     ///< of its first triangle, in the scene of the small file
    std::uint64_t first = 0;  ///< in the large file
    std::size_t mesh = 0;     ///< parts may share one
  };
  std::vector<std::byte> file{};
  std::vector<Part> parts{};
  std::vector<std::vector<std::uint64_t>> meshes{};  ///< triangles of each, from a part's first

  /// The number in the large file of a triangle of the small scene.
  [[nodiscard]] std::uint64_t original(std::uint64_t id) const {
    const Part& part = part_of(id);
    return part.first + meshes[part.mesh][static_cast<std::size_t>(id - part.id)];
  }
  [[nodiscard]] const Part& part_of(std::uint64_t id) const {
    return *std::prev(std::ranges::upper_bound(parts, id, {}, &Part::id));
  }
  [[nodiscard]] static FileSelection of_one(std::vector<std::byte> file,
                                            std::span<const std::uint64_t> triangles) {
    return {std::move(file), {{}}, {{triangles.begin(), triangles.end()}}};
  }
};

struct FileBox : Box3 {
  bool finite = true;  ///< false: the box leaves out vertices that are not
  /// Rounded outwards, so that the point is inside.
  void add(Vec3d p) {
    const Vec3 near = float32_of(p);
    if (!is_finite(near)) {
      finite = false;
      return;
    }
    min = least(min, below(near, p));
    max = greatest(max, -below(-near, -p));
  }
  void add(const FileBox& b) {
    Box3::add(b);
    finite = finite && b.finite;
  }
  [[nodiscard]] bool meets(const FileBox& b) const {
    return min.x <= b.max.x && b.min.x <= max.x && min.y <= b.max.y && b.min.y <= max.y &&
           min.z <= b.max.z && b.min.z <= max.z;
  }

 private:
  static Vec3 below(Vec3 near, Vec3d p) {
    const auto one = [](float x, double exact) {
      return x <= exact ? x : std::nextafter(x, std::numeric_limits<float>::lowest());
    };
    return {one(near.x, p.x), one(near.y, p.y), one(near.z, p.z)};
  }
};

class LongestEdge {
 public:
  void add(Vec3d a, Vec3d b, Vec3d c) {
    add(a, b);
    add(b, c);
    add(c, a);
  }
  /// Rounded up; any value if a vertex is not finite.
  [[nodiscard]] float length() const {
    constexpr double kMore = 1 + 1e-6;  // covers the rounding of float64 and float32
    const double most = std::sqrt(most_) * kMore;
    return most < std::numeric_limits<float>::max() ? static_cast<float>(most)
                                                    : std::numeric_limits<float>::infinity();
  }

 private:
  void add(Vec3d a, Vec3d b) {
    const Vec3d d = a - b;
    most_ = std::max(most_, d.x * d.x + d.y * d.y + d.z * d.z);
  }
  double most_ = 0;
};

class LargeFile {
 public:
  /// Maps `file` and looks at its header. Throws as read_scene, and Error{unsupported} that says
  /// why it cannot be drawn out of core: text, big-endian numbers, faces that are no triangles.
  /// Throws Error{out_of_memory} if what stays in memory (bytes_beside) exceeds `memory_limit`.
  [[nodiscard]] static std::unique_ptr<LargeFile> open(const std::filesystem::path& file,
                                                       std::uint64_t memory_limit = kNoLimit);
  static constexpr std::uint64_t kNoLimit = std::numeric_limits<std::uint64_t>::max();
  virtual ~LargeFile() = default;

  [[nodiscard]] const std::string& name() const { return name_; }
  /// The reader's name of the format (decode_scene).
  [[nodiscard]] const std::string& format() const { return extension_; }
  [[nodiscard]] std::uint64_t triangles() const { return triangles_; }
  /// In order; at least one.
  [[nodiscard]] const std::vector<FilePart>& parts() const { return parts_; }
  [[nodiscard]] std::uint64_t vertices() const { return vertices_; }
  [[nodiscard]] std::uint64_t bytes() const { return mapped_.bytes().size(); }
  [[nodiscard]] virtual bool has_normals() const = 0;
  [[nodiscard]] virtual bool has_materials() const { return false; }
  /// About the bytes of its mesh in memory.
  [[nodiscard]] virtual std::uint64_t bytes_in_memory() const = 0;
  /// Bytes in memory whatever is selected: all but vertices and triangles, twice while a selection
  /// is made and read.
  [[nodiscard]] virtual std::uint64_t bytes_beside() const { return 0; }
  /// The most bytes of a selected triangle, in the small file and in memory.
  [[nodiscard]] virtual std::uint64_t bytes_a_triangle() const = 0;

  /// Reads triangles [first, first + count) of one part. `most_bytes`: of vertices that may stay
  /// mapped; beyond that, those in use are copied. Thread-safe for distinct chunks. Throws
  /// Error{bad_format} that names a triangle with an index out of range, Error{unsupported} for
  /// another face than a triangle, Error{io} if the file has become shorter.
  virtual void read(std::uint64_t first, std::size_t count, std::size_t most_bytes,
                    FileChunk& chunk) const = 0;
  void check_length() const { mapped_.check(); }
  /// Gives back the pages that a chunk has mapped.
  void drop(const FileChunk& chunk) const { mapped_.drop(chunk.mapped_offset, chunk.mapped_bytes); }

  /// A box around triangles [first, first + count) of one part, maybe too large; none before
  /// read_positions has seen all of them.
  [[nodiscard]] virtual std::optional<FileBox> box(std::uint64_t /*first*/,
                                                   std::uint64_t /*count*/) const {
    return {};
  }

  /// An upper bound of the edges of triangles [first, first + count) of one part, in object space;
  /// infinity: unknown.
  [[nodiscard]] virtual float longest_edge(std::uint64_t /*first*/, std::uint64_t /*count*/) const {
    return std::numeric_limits<float>::infinity();
  }

  /// A file of these triangles, which rise, with all their data. Each of several parts gets at
  /// least one triangle. If a colour of the whole file is translucent, so is one here.
  [[nodiscard]] virtual FileSelection selection(std::span<const std::uint64_t> triangles) const = 0;

  /// The runs of the positions that triangles use, in the reader's order. The first call looks at
  /// all indices. Throws as read(), for the first fault.
  [[nodiscard]] virtual std::size_t position_runs(parallel::Threads& threads) const = 0;
  [[nodiscard]] virtual std::size_t part_of_run(std::size_t /*run*/) const { return 0; }
  /// A box around a run; none before read_positions has read all runs.
  [[nodiscard]] virtual std::optional<FileBox> run_box(std::size_t run) const = 0;
  using TakePositions = std::function<void(std::size_t i, std::span<const Vec3d>)>;
  /// Calls f(i, positions) for these runs, which rise: those of runs[i] in order on one thread, in
  /// one call or several. About WalkWindow::kWindow of the file stays mapped meanwhile.
  void read_positions(parallel::Threads& threads, std::span<const std::size_t> runs,
                      const TakePositions& f) const;

 protected:
  explicit LargeFile(const std::filesystem::path& file);
  [[nodiscard]] Bytes bytes_of_file() const { return mapped_.bytes(); }
  [[nodiscard]] const MappedFile& mapped() const { return mapped_; }
  /// Whether `count` float64 positions, `stride` bytes apart, stay float64 by the reader's rule
  /// (wide_positions.hpp). The first ones mostly decide.
  [[nodiscard]] bool lie_far(std::size_t first, std::size_t stride, std::uint64_t count) const;
  [[noreturn]] void fail(const std::string& message) const;
  [[noreturn]] void refuse(const std::string& message) const;

  /// Where a run lies in the file: offset and bytes.
  [[nodiscard]] virtual std::pair<std::size_t, std::size_t> place_of_run(std::size_t run) const = 0;
  /// Calls f with pieces of a run's positions. Thread-safe.
  virtual void read_run(std::size_t run,
                        const std::function<void(std::span<const Vec3d>)>& f) const = 0;
  /// Keeps the boxes of all runs, as read_positions has found them.
  virtual void keep_boxes(std::vector<FileBox> boxes) const = 0;

  /// Calls work(i) for [0, n) on threads, so many at once that their places, which rise, fit into a
  /// window of the file. Places are requested before and released afterwards; then behind(begin,
  /// end) gets the range of i. If calls throw, the exception of the lowest i is thrown.
  void walk(parallel::Threads& threads, std::size_t n,
            const std::function<std::pair<std::size_t, std::size_t>(std::size_t)>& place,
            const std::function<void(std::size_t)>& work,
            const std::function<void(std::size_t begin, std::size_t end)>& behind = {}) const;

  std::string name_;
  std::uint64_t triangles_ = 0, vertices_ = 0;
  std::vector<FilePart> parts_{};  ///< empty: one of all triangles

 private:
  std::string extension_;
  MappedFile mapped_;
};

[[nodiscard]] std::unique_ptr<LargeFile> open_large_ply(const std::filesystem::path& file);
[[nodiscard]] std::unique_ptr<LargeFile> open_large_glb(const std::filesystem::path& file,
                                                        std::uint64_t memory_limit);
[[nodiscard]] std::unique_ptr<LargeFile> open_large_npy(const std::filesystem::path& file);
[[nodiscard]] std::unique_ptr<LargeFile> open_large_stl(const std::filesystem::path& file);

/// Releases pages behind a walk through a file, so that at most kWindow stays mapped.
class WalkWindow {
 public:
  static constexpr std::size_t kWindow = std::size_t{32} << 20;
  WalkWindow(const MappedFile& mapped, std::size_t begin) : mapped_(mapped), behind_(begin) {}
  ~WalkWindow() { leave(at_); }
  WalkWindow(const WalkWindow&) = delete;
  WalkWindow& operator=(const WalkWindow&) = delete;
  /// `offset` never falls.
  void reach(std::size_t offset) {
    at_ = offset;
    if (offset - behind_ >= kWindow) leave(offset);
  }

 private:
  void leave(std::size_t offset) {
    if (offset > behind_) mapped_.drop(behind_, offset - behind_);
    behind_ = std::max(behind_, offset);
  }
  const MappedFile& mapped_;
  std::size_t behind_, at_ = 0;
};

/// A set of numbers from 0 to n, a bit each.
class BitSet {
 public:
  explicit BitSet(std::uint64_t n) : words_((n + 511) / 512 * 8) {}
  void add(std::uint64_t i) { words_[i / 64] |= std::uint64_t{1} << i % 64; }
  /// Thread-safe. Most are added more than once, which costs only a read.
  void add_shared(std::uint64_t i) {
    std::atomic_ref<std::uint64_t> word(words_[i / 64]);
    const std::uint64_t bit = std::uint64_t{1} << i % 64;
    if ((word.load(std::memory_order_relaxed) & bit) == 0)
      word.fetch_or(bit, std::memory_order_relaxed);
  }
  [[nodiscard]] std::uint64_t count() const;
  /// Calls f(i) for each, rising.
  template <class F>
  void for_each(const F& f) const {
    for_each_of(0, words_.size() * 64, f);
  }
  /// Likewise from `begin` to `end`, multiples of 64.
  template <class F>
  void for_each_of(std::size_t begin, std::size_t end, const F& f) const {
    for (std::size_t w = begin / 64; w < std::min(end / 64, words_.size()); ++w)
      for (std::uint64_t m = words_[w]; m != 0; m &= m - 1)
        f(w * 64 + static_cast<std::size_t>(std::countr_zero(m)));
  }
  void clear() { std::ranges::fill(words_, 0); }

 protected:
  std::vector<std::uint64_t> words_;
};

/// A set of vertices with the place of each: 4 more bytes per 512.
class VertexSet : public BitSet {
 public:
  explicit VertexSet(std::size_t n) : BitSet(n), places_(words_.size() / 8) {}
  /// Call it between the last add and the first place. Returns their number.
  std::size_t find_places();
  [[nodiscard]] std::uint32_t place(std::uint64_t v) const;

 private:
  std::vector<std::uint32_t> places_;  ///< of the first of each 512
};

}  // namespace rastrum::io
