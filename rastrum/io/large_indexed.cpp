#include <rastrum/io/large_indexed.hpp>

#include <algorithm>
#include <cstring>
#include <utility>

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

const VertexSet& LargeIndexed::in_use() const {
  const std::scoped_lock lock(looking_);
  if (in_use_) return *in_use_;
  check_length();
  VertexSet used(vertices_);
  std::vector<std::uint32_t> indices(3 * kAtOnce);
  ranges_.clear();
  WalkWindow window(mapped(), first_face_);
  for (std::uint64_t t = 0; t < triangles_; t += kAtOnce) {
    const auto n = static_cast<std::size_t>(std::min<std::uint64_t>(kAtOnce, triangles_ - t));
    Range& range = ranges_.emplace_back();
    copy_indices(t, n, indices.data(), range.lowest, range.highest);
    for (std::size_t i = 0; i < 3 * n; ++i) used.add(indices[i]);
    window.reach(face_at(t + n));
  }
  check_length();
  return in_use_.emplace(std::move(used));
}

void LargeIndexed::for_each_position_in_use(
    const std::function<void(std::span<const Vec3d>)>& f) const {
  const VertexSet& used = in_use();
  std::vector<FileBox> boxes;
  if (boxes_.empty()) boxes.resize((vertices_ + kAtOnce - 1) / kAtOnce);
  std::vector<Vec3d> run;
  run.reserve(kAtOnce);
  WalkWindow window(mapped(), vertex_at(0));
  used.for_each([&](std::size_t v) {
    const std::size_t at = vertex_at(v);
    Vec3 p;
    std::memcpy(&p, bytes_of_file().data() + at + position_, sizeof(p));
    run.emplace_back(p);
    if (!boxes.empty()) boxes[v / kAtOnce].add(p);
    if (run.size() < kAtOnce) return;
    check_length();
    f(run);
    run.clear();
    window.reach(at);
  });
  check_length();
  if (!run.empty()) f(run);
  window.reach(vertex_at(vertices_));
  if (!boxes.empty()) boxes_ = std::move(boxes);
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
