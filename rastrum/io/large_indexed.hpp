// Large files of vertices of one size and triangles of indices of one size: what they have in
// common, wherever these lie.
#pragma once

#include <filesystem>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include <rastrum/io/large_file.hpp>

namespace rastrum::io {

class LargeIndexed : public LargeFile {
 public:
  void read(std::uint64_t first, std::size_t count, std::size_t most_bytes,
            FileChunk& chunk) const override;
  [[nodiscard]] std::size_t position_runs(parallel::Threads& threads) const override;
  [[nodiscard]] std::optional<FileBox> run_box(std::size_t run) const override;
  [[nodiscard]] std::optional<FileBox> box(std::uint64_t first, std::uint64_t count) const override;

 protected:
  static constexpr std::size_t kAtOnce = 1 << 14;

  explicit LargeIndexed(const std::filesystem::path& file) : LargeFile(file) {}
  [[nodiscard]] std::size_t vertex_at(std::uint64_t v) const {
    return first_vertex_ + v * vertex_bytes_;
  }
  [[nodiscard]] std::size_t face_at(std::uint64_t t) const { return first_face_ + t * face_bytes_; }
  /// The indices of triangles [first, first + n), and the range of them and those before. Throws as
  /// read().
  virtual void copy_indices(std::uint64_t first, std::size_t n, std::uint32_t* to,
                            std::uint32_t& lowest, std::uint32_t& highest) const = 0;
  [[noreturn]] void refuse_index(std::uint64_t triangle, std::uint32_t index) const {
    fail("triangle " + std::to_string(triangle) + " refers to vertex " +
         std::to_string(static_cast<std::int32_t>(index) < 0
                            ? static_cast<std::int64_t>(static_cast<std::int32_t>(index))
                            : std::int64_t{index}) +
         ", but the file has " + std::to_string(vertices_));
  }

  std::size_t first_vertex_ = 0, vertex_bytes_ = 0;
  std::size_t position_ = 0;  ///< in a vertex: three float32
  std::size_t first_face_ = 0, face_bytes_ = 0;

 private:
  void gather(FileChunk& chunk) const;
  [[nodiscard]] std::pair<std::size_t, std::size_t> place_of_run(std::size_t run) const override;
  void read_run(std::size_t run,
                const std::function<void(std::span<const Vec3>)>& f) const override;
  void keep_boxes(std::vector<FileBox> boxes) const override { boxes_ = std::move(boxes); }

  mutable std::mutex looking_;
  mutable std::optional<VertexSet> in_use_;
  /// Of each kAtOnce triangles the lowest and the highest vertex, and of as many vertices a box of
  /// those in use. Empty before the first look.
  struct Range {
    std::uint32_t lowest = ~std::uint32_t{0}, highest = 0;
  };
  mutable std::vector<Range> ranges_;
  mutable std::vector<FileBox> boxes_;
};

}  // namespace rastrum::io
