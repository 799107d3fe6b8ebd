// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/io/large_soup.hpp>

#include <algorithm>
#include <cstring>

#include <rastrum/io/wide_positions.hpp>
#include <rastrum/parallel/exec.hpp>

namespace rastrum::io {

void LargeSoup::copy_corners(std::uint64_t first, std::size_t n, Vec3* to) const {
  const std::byte* from = bytes_of_file().data() + triangle_at(first) + corners_;
  for (std::size_t i = 0; i < n; ++i, from += triangle_bytes_, to += 3) {
    if (!wide_) {
      std::memcpy(to, from, 3 * sizeof(Vec3));
      continue;
    }
    Vec3d wide[3];
    std::memcpy(wide, from, sizeof(wide));
    for (int c = 0; c < 3; ++c) to[c] = float32_of(wide[c]);
  }
}

void LargeSoup::read(std::uint64_t first, std::size_t count, std::size_t /*most_bytes*/,
                     FileChunk& chunk) const {
  check_length();
  chunk.first = first;
  chunk.count = count;
  const std::size_t begin = triangle_at(first), bytes = count * triangle_bytes_;
  if (is_in_place()) {
    chunk.mapped_offset = begin;
    chunk.mapped_bytes = bytes;
    mapped().will_need(begin, bytes);
    chunk.positions = ArrayView<Vec3>::in(bytes_of_file(),
                                          {.type = far_ ? NumberType::float64 : NumberType::float32,
                                           .channels = 3,
                                           .count = 3 * count,
                                           .offset_bytes = begin,
                                           .stride_bytes = far_ ? 24 : 12});
    return;
  }
  chunk.copied_positions.resize(3 * count);
  mapped().will_need(begin, bytes);
  WalkWindow window(mapped(), begin);
  constexpr std::size_t kSome = 1 << 16;
  for (std::size_t i = 0; i < count; i += kSome) {
    const std::size_t n = std::min(kSome, count - i);
    copy_corners(first + i, n, chunk.copied_positions.data() + 3 * i);
    window.reach(triangle_at(first + i + n));
  }
  check_length();
  chunk.positions = chunk.copied_positions;
}

FileSelection LargeSoup::selection(std::span<const std::uint64_t> triangles) const {
  check_length();
  std::vector<std::byte> small = header_of(triangles.size());
  std::size_t to = small.size();
  // Float64 of some triangles would not tell the reader that the whole file is rounded.
  const bool rounded = wide_ && !far_;
  const std::size_t each = rounded ? 3 * sizeof(Vec3) : triangle_bytes_;
  small.resize(to + triangles.size() * each);
  WalkWindow window(mapped(), first_triangle_);
  for (const std::uint64_t t : triangles) {
    window.reach(triangle_at(t));
    if (rounded) {
      Vec3 corners[3];
      copy_corners(t, 1, corners);
      std::memcpy(small.data() + to, corners, each);
    } else {
      std::memcpy(small.data() + to, bytes_of_file().data() + triangle_at(t), each);
    }
    to += each;
  }
  return FileSelection::of_one(std::move(small), triangles);
}

std::size_t LargeSoup::position_runs(parallel::Threads& /*threads*/) const {
  const std::size_t runs = (triangles_ + kAtOnce - 1) / kAtOnce;
  if (boxes_.empty()) longest_.resize(runs);
  return runs;
}

std::optional<FileBox> LargeSoup::run_box(std::size_t run) const {
  if (boxes_.empty()) return {};
  return boxes_[run];
}

std::pair<std::size_t, std::size_t> LargeSoup::place_of_run(std::size_t run) const {
  const std::uint64_t first = std::uint64_t{run} * kAtOnce;
  return {triangle_at(first),
          std::min<std::uint64_t>(kAtOnce, triangles_ - first) * triangle_bytes_};
}

void LargeSoup::read_run(std::size_t run,
                         const std::function<void(std::span<const Vec3d>)>& f) const {
  constexpr std::size_t kSome = 128;
  Vec3 rounded[3 * kSome];
  Vec3d corners[3 * kSome];
  LongestEdge longest;
  std::uint64_t first = std::uint64_t{run} * kAtOnce;
  const std::uint64_t end = std::min(first + kAtOnce, triangles_);
  while (first < end) {
    const auto n = static_cast<std::size_t>(std::min<std::uint64_t>(kSome, end - first));
    if (far_) {
      std::memcpy(corners, bytes_of_file().data() + triangle_at(first), n * triangle_bytes_);
    } else {
      copy_corners(first, n, rounded);
      std::copy_n(rounded, 3 * n, corners);
    }
    f(std::span(corners, 3 * n));
    first += n;
    for (std::size_t t = 0; boxes_.empty() && t < n; ++t)
      longest.add(corners[3 * t], corners[3 * t + 1], corners[3 * t + 2]);
  }
  if (boxes_.empty()) longest_[run] = longest.length();
}

float LargeSoup::longest_edge(std::uint64_t first, std::uint64_t count) const {
  if (boxes_.empty() || count == 0) return std::numeric_limits<float>::infinity();
  const auto begin = longest_.begin() + static_cast<std::ptrdiff_t>(first / kAtOnce);
  const auto last = longest_.begin() + static_cast<std::ptrdiff_t>((first + count - 1) / kAtOnce);
  return *std::max_element(begin, last + 1);
}

std::optional<FileBox> LargeSoup::box(std::uint64_t first, std::uint64_t count) const {
  if (boxes_.empty() || count == 0) return {};
  FileBox box;
  for (std::uint64_t b = first / kAtOnce; b <= (first + count - 1) / kAtOnce; ++b)
    box.add(boxes_[b]);
  return box;
}

}  // namespace rastrum::io
