#include <rastrum/io/large_indexed.hpp>

#include <algorithm>
#include <cstring>
#include <utility>

#include <rastrum/parallel/exec.hpp>

namespace rastrum::io {

void LargeIndexed::read(std::uint64_t first, std::size_t count, std::size_t most_bytes,
                        FileChunk& chunk) const {
  check_length();
  chunk.first = first;
  chunk.count = count;
  chunk.copied_indices.resize(3 * count);
  mapped().will_need(face_at(first + count), count * face_bytes_);
  std::uint32_t lowest = ~std::uint32_t{0}, highest = 0;
  {
    WalkWindow window(mapped(), face_at(first));
    for (std::size_t i = 0; i < count; i += kAtOnce) {
      const std::size_t n = std::min(kAtOnce, count - i);
      copy_indices(first + i, n, chunk.copied_indices.data() + 3 * i, lowest, highest);
      window.reach(face_at(first + i + n));
    }
  }
  check_length();
  if (count == 0) return;
  const std::size_t bytes = (std::size_t{highest} - lowest + 1) * vertex_bytes_;
  if (bytes > most_bytes) return gather(chunk);
  chunk.mapped_offset = vertex_at(lowest);
  chunk.mapped_bytes = bytes;
  mapped().will_need(chunk.mapped_offset, bytes);
  for (std::uint32_t& i : chunk.copied_indices) i -= lowest;
  chunk.indices = chunk.copied_indices;
  chunk.positions = ArrayView<Vec3>::in(
      bytes_of_file(), {.type = NumberType::float32,
                        .channels = 3,
                        .count = std::size_t{highest} - lowest + 1,
                        .offset_bytes = chunk.mapped_offset + position_,
                        .stride_bytes = static_cast<std::ptrdiff_t>(vertex_bytes_)});
}

/// Copies the vertices that a chunk uses, whose indices are the file's, and counts them anew.
void LargeIndexed::gather(FileChunk& chunk) const {
  VertexSet used(vertices_);
  for (const std::uint32_t i : chunk.copied_indices) used.add(i);
  chunk.copied_positions.resize(used.count());
  Vec3* to = chunk.copied_positions.data();
  {
    WalkWindow window(mapped(), vertex_at(0));
    used.for_each([&](std::size_t v) {
      window.reach(vertex_at(v));
      std::memcpy(to++, bytes_of_file().data() + vertex_at(v) + position_, sizeof(Vec3));
    });
  }
  for (std::uint32_t& i : chunk.copied_indices) i = used.place(i);
  chunk.indices = chunk.copied_indices;
  chunk.positions = chunk.copied_positions;
  chunk.mapped_offset = chunk.mapped_bytes = 0;
}

std::size_t LargeIndexed::position_runs(parallel::Threads& threads) const {
  const std::size_t runs = (vertices_ + kAtOnce - 1) / kAtOnce;
  const std::scoped_lock lock(looking_);
  if (in_use_) return runs;
  check_length();
  VertexSet used(vertices_);
  ranges_.assign((triangles_ + kAtOnce - 1) / kAtOnce, {});
  const auto size = [&](std::size_t i) {
    return static_cast<std::size_t>(std::min<std::uint64_t>(kAtOnce, triangles_ - i * kAtOnce));
  };
  walk(
      threads, ranges_.size(),
      [&](std::size_t i) { return std::pair(face_at(i * kAtOnce), size(i) * face_bytes_); },
      [&](std::size_t i) {
        constexpr std::size_t kSome = 1 << 10;
        std::uint32_t indices[3 * kSome];
        for (std::size_t t = 0; t < size(i); t += kSome) {
          const std::size_t n = std::min(kSome, size(i) - t);
          copy_indices(i * kAtOnce + t, n, indices, ranges_[i].lowest, ranges_[i].highest);
          for (std::size_t k = 0; k < 3 * n; ++k) used.add_shared(indices[k]);
        }
      });
  in_use_.emplace(std::move(used));
  return runs;
}

std::pair<std::size_t, std::size_t> LargeIndexed::place_of_run(std::size_t run) const {
  const std::uint64_t first = std::uint64_t{run} * kAtOnce;
  return {vertex_at(first), std::min<std::uint64_t>(kAtOnce, vertices_ - first) * vertex_bytes_};
}

void LargeIndexed::read_run(std::size_t run,
                            const std::function<void(std::span<const Vec3>)>& f) const {
  constexpr std::size_t kSome = 1 << 10;
  Vec3 some[kSome];
  std::size_t n = 0;
  const std::byte* const at = bytes_of_file().data() + vertex_at(0) + position_;
  in_use_->for_each_of(run * kAtOnce, (run + 1) * kAtOnce, [&](std::size_t v) {
    std::memcpy(&some[n++], at + v * vertex_bytes_, sizeof(Vec3));
    if (n < kSome) return;
    f(some);
    n = 0;
  });
  if (n != 0) f(std::span(some, n));
}

std::optional<FileBox> LargeIndexed::run_box(std::size_t run) const {
  if (boxes_.empty()) return {};
  return boxes_[run];
}

std::optional<FileBox> LargeIndexed::box(std::uint64_t first, std::uint64_t count) const {
  if (boxes_.empty() || count == 0) return {};
  Range range;
  for (std::uint64_t r = first / kAtOnce; r <= (first + count - 1) / kAtOnce; ++r) {
    range.lowest = std::min(range.lowest, ranges_[r].lowest);
    range.highest = std::max(range.highest, ranges_[r].highest);
  }
  FileBox box;
  for (std::size_t b = range.lowest / kAtOnce; b <= range.highest / kAtOnce; ++b)
    box.add(boxes_[b]);
  return box;
}

}  // namespace rastrum::io
