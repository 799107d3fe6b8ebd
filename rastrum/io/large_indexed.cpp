// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/io/large_indexed.hpp>

#include <algorithm>
#include <cstring>
#include <limits>
#include <utility>

#include <rastrum/parallel/exec.hpp>

namespace rastrum::io {

std::size_t LargeIndexed::part_at(std::uint64_t triangle) const {
  const auto after = std::ranges::upper_bound(parts(), triangle, {}, &FilePart::first);
  return static_cast<std::size_t>(after - parts().begin()) - 1;
}

void LargeIndexed::read(std::uint64_t first, std::size_t count, std::size_t most_bytes,
                        FileChunk& chunk) const {
  check_length();
  const std::size_t part = part_at(first);
  const IndexedPlace& mesh = meshes_[mesh_of(part)];
  const std::uint64_t begin = first - parts()[part].first;
  chunk.first = first;
  chunk.count = count;
  chunk.copied_indices.resize(3 * count);
  mapped().will_need(mesh.face_at(begin), mesh.face_at(begin + count) - mesh.face_at(begin));
  std::uint32_t lowest = ~std::uint32_t{0}, highest = 0;
  {
    WalkWindow window(mapped(), mesh.face_at(begin));
    for (std::size_t i = 0; i < count; i += kAtOnce) {
      const std::size_t n = std::min(kAtOnce, count - i);
      copy_indices(mesh, begin + i, n, chunk.copied_indices.data() + 3 * i, lowest, highest);
      window.reach(mesh.face_at(begin + i + n));
    }
  }
  check_length();
  if (count == 0) return;
  const std::size_t bytes = (std::size_t{highest} - lowest + 1) * mesh.vertex_bytes;
  if (mesh.far && bytes > most_bytes)
    return gather(mesh, lowest, highest, chunk, chunk.copied_wide_positions);
  if (!mesh.far && (mesh.wide || bytes > most_bytes))
    return gather(mesh, lowest, highest, chunk, chunk.copied_positions);
  chunk.mapped_offset = mesh.vertex_at(lowest);
  chunk.mapped_bytes = bytes;
  mapped().will_need(chunk.mapped_offset, bytes);
  for (std::uint32_t& i : chunk.copied_indices) i -= lowest;
  chunk.indices = chunk.copied_indices;
  chunk.positions = ArrayView<Vec3>::in(
      bytes_of_file(), {.type = mesh.far ? NumberType::float64 : NumberType::float32,
                        .channels = 3,
                        .count = std::size_t{highest} - lowest + 1,
                        .offset_bytes = chunk.mapped_offset + mesh.position,
                        .stride_bytes = static_cast<std::ptrdiff_t>(mesh.vertex_bytes)});
}

/// As the reader rounds it.
Vec3d LargeIndexed::position_at(const IndexedPlace& mesh, std::uint64_t v) const {
  const std::byte* const at = bytes_of_file().data() + mesh.vertex_at(v) + mesh.position;
  Vec3 p;
  if (!mesh.wide) {
    std::memcpy(&p, at, sizeof(p));
    return p;
  }
  Vec3d wide;
  std::memcpy(&wide, at, sizeof(wide));
  return mesh.far ? wide : Vec3d(float32_of(wide));
}

/// Copies the vertices that a chunk uses and renumbers its indices, which are the file's.
template <class P>
void LargeIndexed::gather(const IndexedPlace& mesh, std::uint32_t lowest, std::uint32_t highest,
                          FileChunk& chunk, std::vector<P>& to) const {
  VertexSet used(std::size_t{highest} - lowest + 1);
  for (std::uint32_t& i : chunk.copied_indices) used.add(i -= lowest);
  to.clear();
  to.reserve(used.find_places());
  {
    WalkWindow window(mapped(), mesh.vertex_at(lowest));
    used.for_each([&](std::size_t v) {
      window.reach(mesh.vertex_at(lowest + v));
      to.emplace_back(position_at(mesh, lowest + v));
    });
  }
  for (std::uint32_t& i : chunk.copied_indices) i = used.place(i);
  chunk.indices = chunk.copied_indices;
  chunk.positions = to;
  chunk.mapped_offset = chunk.mapped_bytes = 0;
}

float LargeIndexed::longest_of(const IndexedPlace& mesh,
                               std::span<const std::uint32_t> corners) const {
  LongestEdge longest;
  for (std::size_t i = 0; i < corners.size(); i += 3)
    longest.add(position_at(mesh, corners[i]), position_at(mesh, corners[i + 1]),
                position_at(mesh, corners[i + 2]));
  return longest.length();
}

LargeIndexed::Look LargeIndexed::look_at(const IndexedPlace& mesh,
                                         parallel::Threads& threads) const {
  Look look{VertexSet(mesh.vertices), std::vector<Range>((mesh.triangles + kAtOnce - 1) / kAtOnce)};
  const auto size = [&](std::size_t i) {
    return static_cast<std::size_t>(std::min<std::uint64_t>(kAtOnce, mesh.triangles - i * kAtOnce));
  };
  // Vertices of a few rows of a grid. A mesh in no order would read all of them repeatedly.
  constexpr std::size_t kNear = std::size_t{1} << 20;
  const std::size_t near = kNear / mesh.vertex_bytes;
  walk(
      threads, look.ranges.size(),
      [&](std::size_t i) {
        const std::size_t at = mesh.face_at(i * kAtOnce);
        return std::pair(at, mesh.face_at(i * kAtOnce + size(i)) - at);
      },
      [&](std::size_t i) {
        constexpr std::size_t kSome = 1 << 10;
        std::uint32_t indices[3 * kSome];
        Range& range = look.ranges[i];
        for (std::size_t t = 0; t < size(i); t += kSome) {
          const std::size_t n = std::min(kSome, size(i) - t);
          Range some;
          copy_indices(mesh, i * kAtOnce + t, n, indices, some.lowest, some.highest);
          for (std::size_t k = 0; k < 3 * n; ++k) look.used.add_shared(indices[k]);
          some.longest_edge = some.highest - some.lowest < near
                                  ? longest_of(mesh, std::span(indices, 3 * n))
                                  : std::numeric_limits<float>::infinity();
          range.add(some);
        }
      },
      [&](std::size_t begin, std::size_t end) {
        Range looked_at;
        for (std::size_t i = begin; i < end; ++i) {
          const Range& range = look.ranges[i];
          if (range.longest_edge != std::numeric_limits<float>::infinity()) looked_at.add(range);
        }
        if (looked_at.lowest <= looked_at.highest)
          mapped().drop(
              mesh.vertex_at(looked_at.lowest),
              (std::size_t{looked_at.highest} - looked_at.lowest + 1) * mesh.vertex_bytes);
      });
  return look;
}

std::size_t LargeIndexed::position_runs(parallel::Threads& threads) const {
  const std::scoped_lock lock(looking_);
  if (looks_.empty()) {
    check_length();
    std::vector<Look> looks;
    for (const IndexedPlace& mesh : meshes_) looks.push_back(look_at(mesh, threads));
    first_of_mesh_.assign(1, 0);
    for (const IndexedPlace& mesh : meshes_)
      first_of_mesh_.push_back(first_of_mesh_.back() + runs_of(mesh));
    first_run_.assign(1, 0);
    for (std::size_t part = 0; part < parts().size(); ++part)
      first_run_.push_back(first_run_.back() + runs_of(meshes_[mesh_of(part)]));
    looks_ = std::move(looks);
  }
  // The boxes of a mesh at one node are found by the first that asks. A mesh at several nodes would
  // be read once per node for them, so its boxes are found here; again if a stop came in between.
  if (boxes_.empty()) {
    std::vector<std::size_t> of_parts = mesh_of_part_;
    std::ranges::sort(of_parts);
    if (std::ranges::adjacent_find(of_parts) != of_parts.end()) look_for_boxes(threads);
  }
  return first_run_.back();
}

void LargeIndexed::look_for_boxes(parallel::Threads& threads) const {
  std::vector<FileBox> boxes(first_of_mesh_.back());
  for (std::size_t k = 0; k < meshes_.size(); ++k)
    walk(
        threads, runs_of(meshes_[k]), [&](std::size_t i) { return place_in_mesh(k, i); },
        [&](std::size_t i) {
          FileBox box;
          read_in_mesh(k, i, [&](std::span<const Vec3d> positions) {
            for (const Vec3d& p : positions) box.add(p);
          });
          boxes[first_of_mesh_[k] + i] = box;
        });
  check_length();
  boxes_ = std::move(boxes);
}

std::size_t LargeIndexed::run_of_mesh(std::size_t run) const {
  const std::size_t part = part_of_run(run);
  return first_of_mesh_[mesh_of(part)] + (run - first_run_[part]);
}

void LargeIndexed::keep_boxes(std::vector<FileBox> boxes) const {
  std::vector<FileBox> of_meshes(first_of_mesh_.back());
  for (std::size_t run = 0; run < boxes.size(); ++run) of_meshes[run_of_mesh(run)] = boxes[run];
  boxes_ = std::move(of_meshes);
}

std::size_t LargeIndexed::part_of_run(std::size_t run) const {
  const auto after = std::ranges::upper_bound(first_run_, run);
  return static_cast<std::size_t>(after - first_run_.begin()) - 1;
}

std::pair<std::size_t, std::size_t> LargeIndexed::place_in_mesh(std::size_t mesh_number,
                                                                std::size_t run) const {
  const IndexedPlace& mesh = meshes_[mesh_number];
  const std::uint64_t first = std::uint64_t{run} * kAtOnce;
  return {mesh.vertex_at(first),
          std::min<std::uint64_t>(kAtOnce, mesh.vertices - first) * mesh.vertex_bytes};
}

std::pair<std::size_t, std::size_t> LargeIndexed::place_of_run(std::size_t run) const {
  const std::size_t part = part_of_run(run);
  return place_in_mesh(mesh_of(part), run - first_run_[part]);
}

void LargeIndexed::read_run(std::size_t run,
                            const std::function<void(std::span<const Vec3d>)>& f) const {
  const std::size_t part = part_of_run(run);
  read_in_mesh(mesh_of(part), run - first_run_[part], f);
}

void LargeIndexed::read_in_mesh(std::size_t mesh_number, std::size_t run,
                                const std::function<void(std::span<const Vec3d>)>& f) const {
  const IndexedPlace& mesh = meshes_[mesh_number];
  const std::size_t first = run * kAtOnce;
  constexpr std::size_t kSome = 512;  // fits into the first-level cache
  Vec3d some[kSome];
  std::size_t n = 0;
  looks_[mesh_number].used.for_each_of(first, first + kAtOnce, [&](std::size_t v) {
    some[n++] = position_at(mesh, v);
    if (n < kSome) return;
    f(some);
    n = 0;
  });
  if (n != 0) f(std::span(some, n));
}

std::optional<FileBox> LargeIndexed::run_box(std::size_t run) const {
  if (boxes_.empty()) return {};
  return boxes_[run_of_mesh(run)];
}

LargeIndexed::Range LargeIndexed::range_of(std::size_t part, std::uint64_t first,
                                           std::uint64_t count) const {
  const std::vector<Range>& ranges = looks_[mesh_of(part)].ranges;
  first -= parts()[part].first;
  Range range;
  for (std::uint64_t r = first / kAtOnce; r <= (first + count - 1) / kAtOnce; ++r)
    range.add(ranges[r]);
  return range;
}

float LargeIndexed::longest_edge(std::uint64_t first, std::uint64_t count) const {
  if (looks_.empty() || count == 0) return std::numeric_limits<float>::infinity();
  return range_of(part_at(first), first, count).longest_edge;
}

std::optional<FileBox> LargeIndexed::box(std::uint64_t first, std::uint64_t count) const {
  if (boxes_.empty() || count == 0) return {};
  const std::size_t part = part_at(first);
  const Range range = range_of(part, first, count);
  FileBox box;
  for (std::size_t b = range.lowest / kAtOnce; b <= range.highest / kAtOnce; ++b)
    box.add(boxes_[first_of_mesh_[mesh_of(part)] + b]);
  return box;
}

}  // namespace rastrum::io
