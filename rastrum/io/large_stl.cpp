// Binary STL out of core. A facet has its corners side by side, behind a normal that nobody reads;
// a chunk copies them, 36 bytes of 50.
#include <algorithm>
#include <bit>
#include <cstring>
#include <string>
#include <utility>

#include <rastrum/io/large_file.hpp>

namespace rastrum::io {
namespace {

constexpr std::size_t kStlHeader = 84, kStlFacet = 50, kStlCorners = 12;

class LargeStl final : public LargeFile {
 public:
  explicit LargeStl(const std::filesystem::path& file) : LargeFile(file) {
    const Bytes bytes = bytes_of_file();
    if (as_text(bytes).starts_with("solid") && !is_exact(bytes))
      refuse("it seems to be text; write it as binary STL");
    if (bytes.size() < kStlHeader)
      fail("is not STL: " + std::to_string(bytes.size()) + " bytes that do not begin with 'solid'");
    if constexpr (std::endian::native != std::endian::little)
      refuse("its numbers are not in this machine's order");
    triangles_ = count_of(bytes);
    const std::size_t capacity = (bytes.size() - kStlHeader) / kStlFacet;
    if (triangles_ > capacity || (triangles_ == 0 && bytes.size() > kStlHeader))
      fail("the header says " + std::to_string(triangles_) +
           " triangles, but there are bytes for " + std::to_string(capacity));
    vertices_ = 3 * triangles_;
  }

  [[nodiscard]] std::string_view format() const override { return "stl"; }
  [[nodiscard]] bool has_normals() const override { return false; }
  [[nodiscard]] std::uint64_t bytes_in_memory() const override { return triangles_ * (12 + 6); }
  /// 50 in the small file; 12 of indices, three vertices and three times the slots of the reader's
  /// table of vertices.
  [[nodiscard]] std::uint64_t bytes_a_triangle() const override { return 50 + 12 + 3 * (12 + 16); }

  void read(std::uint64_t first, std::size_t count, std::size_t /*most_bytes*/,
            FileChunk& chunk) const override {
    check_length();
    chunk.first = first;
    chunk.count = count;
    chunk.copied_positions.resize(3 * count);
    const std::size_t begin = kStlHeader + first * kStlFacet;
    mapped().will_need(begin + count * kStlFacet, count * kStlFacet);
    WalkWindow window(mapped(), begin);
    const std::byte* from = bytes_of_file().data() + begin + kStlCorners;
    for (std::size_t i = 0; i < count; ++i, from += kStlFacet) {
      std::memcpy(&chunk.copied_positions[3 * i], from, 36);
      if (i % 65536 == 0) window.reach(begin + i * kStlFacet);
    }
    window.reach(begin + count * kStlFacet);
    check_length();
    chunk.positions = chunk.copied_positions;
  }

  [[nodiscard]] std::vector<std::byte> selection(
      std::span<const std::uint64_t> triangles) const override {
    check_length();
    const std::byte* const bytes = bytes_of_file().data();
    std::vector<std::byte> small(kStlHeader + triangles.size() * kStlFacet);
    std::memcpy(small.data(), bytes, kStlHeader);
    const auto count = static_cast<std::uint32_t>(triangles.size());
    std::memcpy(small.data() + 80, &count, sizeof(count));
    WalkWindow window(mapped(), kStlHeader);
    std::byte* to = small.data() + kStlHeader;
    for (const std::uint64_t t : triangles) {
      window.reach(kStlHeader + t * kStlFacet);
      std::memcpy(to, bytes + kStlHeader + t * kStlFacet, kStlFacet);
      to += kStlFacet;
    }
    return small;
  }

  [[nodiscard]] std::size_t position_runs(parallel::Threads& /*threads*/) const override {
    return (triangles_ + kAtOnce - 1) / kAtOnce;
  }
  [[nodiscard]] std::optional<FileBox> run_box(std::size_t run) const override {
    if (boxes_.empty()) return {};
    return boxes_[run];
  }
  [[nodiscard]] std::optional<FileBox> box(std::uint64_t first,
                                           std::uint64_t count) const override {
    if (boxes_.empty() || count == 0) return {};
    FileBox box;
    for (std::uint64_t b = first / kAtOnce; b <= (first + count - 1) / kAtOnce; ++b)
      box.add(boxes_[b]);
    return box;
  }

 private:
  [[nodiscard]] static std::uint32_t count_of(Bytes bytes) {
    std::uint32_t count = 0;
    std::memcpy(&count, bytes.data() + 80, sizeof(count));
    return count;
  }
  [[nodiscard]] static bool is_exact(Bytes bytes) {
    return bytes.size() >= kStlHeader &&
           bytes.size() == kStlHeader + std::size_t{count_of(bytes)} * kStlFacet;
  }

  [[nodiscard]] std::pair<std::size_t, std::size_t> place_of_run(std::size_t run) const override {
    const std::uint64_t first = std::uint64_t{run} * kAtOnce;
    return {kStlHeader + first * kStlFacet,
            std::min<std::uint64_t>(kAtOnce, triangles_ - first) * kStlFacet};
  }
  void read_run(std::size_t run,
                const std::function<void(std::span<const Vec3>)>& f) const override {
    const auto [offset, bytes] = place_of_run(run);
    constexpr std::size_t kSome = 256;
    Vec3 corners[3 * kSome];
    const std::byte* from = bytes_of_file().data() + offset + kStlCorners;
    for (std::size_t left = bytes / kStlFacet; left != 0;) {
      const std::size_t n = std::min(kSome, left);
      for (std::size_t t = 0; t < n; ++t, from += kStlFacet)
        std::memcpy(&corners[3 * t], from, 3 * sizeof(Vec3));
      f(std::span(corners, 3 * n));
      left -= n;
    }
  }
  void keep_boxes(std::vector<FileBox> boxes) const override { boxes_ = std::move(boxes); }

  static constexpr std::size_t kAtOnce = 1 << 14;
  mutable std::vector<FileBox> boxes_;  ///< of as many triangles each, since all were looked at
};

}  // namespace

std::unique_ptr<LargeFile> open_large_stl(const std::filesystem::path& file) {
  return std::make_unique<LargeStl>(file);
}

}  // namespace rastrum::io
