// SPDX-License-Identifier: BSD-3-Clause
// Finds the triangles that share a position with a marked one. A table holds the positions of
// marked triangles by value, because crease_normals takes equal positions for one point. Then all
// triangles are looked up. All meshes share one table: a triangle that is marked needlessly is
// drawn, and hidden again.
#include <algorithm>
#include <array>
#include <bit>
#include <span>
#include <vector>

#include <rastrum/out_of_core/picture.hpp>
#include <rastrum/vec.hpp>

namespace rastrum::out_of_core {
namespace {

/// A set of positions, behind a bit filter that rejects most others.
class Points {
 public:
  using Key = std::array<std::uint32_t, 3>;

  explicit Points(std::size_t most)
      : slots_(std::bit_ceil(most * 3 / 2 + 16)), filter_(std::bit_ceil(most / 4 + 1024)) {}

  /// Call it at most as often as the constructor was told.
  void add(Vec3 p) {
    const Key key = key_of(p);
    const std::uint64_t h = hash(key);
    filter_[h % filter_.size()] |= bit(h);
    std::size_t at = h % slots_.size();
    while (slots_[at] != Key{}) {
      if (slots_[at] == key) return;
      at = (at + 1) % slots_.size();
    }
    if (key == Key{})
      zero_ = true;
    else
      slots_[at] = key;
  }
  [[nodiscard]] bool has(Vec3 p) const {
    const Key key = key_of(p);
    const std::uint64_t h = hash(key);
    if ((filter_[h % filter_.size()] & bit(h)) == 0) return false;
    if (key == Key{}) return zero_;
    for (std::size_t at = h % slots_.size(); slots_[at] != Key{}; at = (at + 1) % slots_.size())
      if (slots_[at] == key) return true;
    return false;
  }

 private:
  static Key key_of(Vec3 p) {
    return std::bit_cast<Key>(Vec3{p.x + 0.0F, p.y + 0.0F, p.z + 0.0F});  // makes -0 equal 0
  }
  static std::uint64_t hash(const Key& k) {
    std::uint64_t h = (std::uint64_t{k[0]} << 32 | k[1]) * 0x9E3779B97F4A7C15ULL;
    h = (h ^ h >> 32 ^ k[2]) * 0xD6E8FEB86659FD93ULL;
    return h ^ h >> 32;
  }
  static std::uint64_t bit(std::uint64_t h) { return std::uint64_t{1} << (h >> 58); }

  std::vector<Key> slots_;  ///< all zero: empty
  std::vector<std::uint64_t> filter_;
  bool zero_ = false;
};

Vec3 corner(const io::FileChunk& chunk, std::size_t c) {
  return chunk.positions[chunk.indices.empty() ? c : chunk.indices[c]];
}

}  // namespace

void mark_neighbours(const io::LargeFile& file, Chunks& chunks, parallel::Threads& threads,
                     Marks& marks,
                     FunctionRef<void(std::uint64_t done, std::uint64_t all)> progress) {
  const std::vector<std::uint64_t> triangles = list_of(marks);
  const std::uint64_t all = 2 * file.triangles();
  Points points(3 * triangles.size());
  io::FileBox around;
  const auto range = [&](std::uint64_t first, std::uint64_t count) {
    const auto begin = std::ranges::lower_bound(triangles, first);
    return std::span(begin, std::ranges::lower_bound(begin, triangles.end(), first + count));
  };
  chunks.walk(
      [&](const io::FileChunk& chunk, const Chunks::Place& /*at*/) {
        for (const std::uint64_t t : range(chunk.first, chunk.count))
          for (std::size_t c = 0; c < 3; ++c) {
            const Vec3 p = corner(chunk, 3 * static_cast<std::size_t>(t - chunk.first) + c);
            points.add(p);
            around.add(p);
          }
        progress(chunk.first + chunk.count, all);
      },
      [&](const Chunks::Place& at) { return !range(at.first, at.count).empty(); });
  constexpr std::size_t kGrain = 1 << 14;
  chunks.walk(
      [&](const io::FileChunk& chunk, const Chunks::Place& /*at*/) {
        parallel::for_each_index(
            threads, (chunk.count + kGrain - 1) / kGrain, [&](std::size_t part) {
              const std::size_t end = std::min(chunk.count, (part + 1) * kGrain);
              for (std::size_t t = part * kGrain; t < end; ++t)
                if (points.has(corner(chunk, 3 * t)) || points.has(corner(chunk, 3 * t + 1)) ||
                    points.has(corner(chunk, 3 * t + 2)))
                  marks.add_shared(chunk.first + t);
            });
        progress(file.triangles() + chunk.first + chunk.count, all);
      },
      [&](const Chunks::Place& at) {
        const std::optional<io::FileBox> box = chunks.box(at);
        return !box || !around.finite || box->meets(around);
      });
}

}  // namespace rastrum::out_of_core
