// SPDX-License-Identifier: BSD-3-Clause
// Large files of triangles without indices: nine numbers each, at equal distances.
#pragma once

#include <filesystem>
#include <optional>
#include <utility>
#include <vector>

#include <rastrum/io/large_file.hpp>

namespace rastrum::io {

class LargeSoup : public LargeFile {
 public:
  [[nodiscard]] bool has_normals() const override { return false; }
  [[nodiscard]] std::uint64_t bytes_in_memory() const override {
    return triangles_ * (12 + vertex_in_memory() / 2);
  }
  /// The small file; 12 of indices; three vertices and three times the slots of the reader's table.
  [[nodiscard]] std::uint64_t bytes_a_triangle() const override {
    return triangle_bytes_ + 12 + 3 * (vertex_in_memory() + 16);
  }

  /// Reads in place if the numbers are contiguous and need no rounding; else copies.
  void read(std::uint64_t first, std::size_t count, std::size_t most_bytes,
            FileChunk& chunk) const override;
  [[nodiscard]] FileSelection selection(std::span<const std::uint64_t> triangles) const override;
  [[nodiscard]] std::size_t position_runs(parallel::Threads& threads) const override;
  [[nodiscard]] std::optional<FileBox> run_box(std::size_t run) const override;
  [[nodiscard]] std::optional<FileBox> box(std::uint64_t first, std::uint64_t count) const override;
  [[nodiscard]] float longest_edge(std::uint64_t first, std::uint64_t count) const override;

 protected:
  explicit LargeSoup(const std::filesystem::path& file) : LargeFile(file) {}
  [[nodiscard]] virtual std::vector<std::byte> header_of(std::size_t triangles) const = 0;

  std::size_t first_triangle_ = 0, triangle_bytes_ = 0;
  std::size_t corners_ = 0;  ///< their offset in a triangle
  bool wide_ = false;        ///< corners are float64
  bool far_ = false;         ///< and stay float64, by the reader's rule

 private:
  static constexpr std::size_t kAtOnce = 1 << 14;

  [[nodiscard]] std::size_t triangle_at(std::uint64_t t) const {
    return first_triangle_ + t * triangle_bytes_;
  }
  [[nodiscard]] std::uint64_t vertex_in_memory() const { return far_ ? 12 + 24 : 12; }
  [[nodiscard]] bool is_in_place() const {
    return far_ || (!wide_ && triangle_bytes_ == 3 * sizeof(Vec3));
  }
  void copy_corners(std::uint64_t first, std::size_t n, Vec3* to) const;
  [[nodiscard]] std::pair<std::size_t, std::size_t> place_of_run(std::size_t run) const override;
  void read_run(std::size_t run,
                const std::function<void(std::span<const Vec3d>)>& f) const override;
  void keep_boxes(std::vector<FileBox> boxes) const override { boxes_ = std::move(boxes); }

  mutable std::vector<float> longest_;  ///< edge per kAtOnce triangles; written with the boxes
  mutable std::vector<FileBox> boxes_;  ///< of kAtOnce triangles each; empty until all were read
};

}  // namespace rastrum::io
