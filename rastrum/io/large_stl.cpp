// Binary STL out of core. A facet has its corners side by side, behind a normal that nobody reads;
// a chunk copies them, 36 bytes of 50.
#include <algorithm>
#include <bit>
#include <cstring>
#include <mutex>
#include <string>

#include <rastrum/io/large_soup.hpp>
#include <rastrum/io/stl_colors.hpp>

namespace rastrum::io {
namespace {

constexpr std::size_t kStlHeader = StlColors::kHeader, kStlFacet = StlColors::kFacet,
                      kStlCorners = 12;

class LargeStl final : public LargeSoup {
 public:
  explicit LargeStl(const std::filesystem::path& file) : LargeSoup(file) {
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
    first_triangle_ = kStlHeader;
    triangle_bytes_ = kStlFacet;
    corners_ = kStlCorners;
  }

  [[nodiscard]] std::string_view format() const override { return "stl"; }
  /// With colours, an index for each corner and a colour.
  [[nodiscard]] std::uint64_t bytes_a_triangle() const override {
    return LargeSoup::bytes_a_triangle() + (has_colors() ? 16 + 16 : 0);
  }

 private:
  [[nodiscard]] std::vector<std::byte> header_of(std::size_t triangles) const override {
    std::vector<std::byte> header(kStlHeader);
    std::memcpy(header.data(), bytes_of_file().data(), kStlHeader);
    const auto count = static_cast<std::uint32_t>(triangles);
    std::memcpy(header.data() + 80, &count, sizeof(count));
    if (has_colors()) {
      // The facets of the selection alone might not show that attributes are colours.
      const StlColors colors(bytes_of_file().first(80));
      const std::string_view whole =
          colors.is_magics() ? as_text(bytes_of_file()).substr(0, 80) : std::string_view{};
      const std::size_t at = std::min(whole.find("COLOR="), whole.find("MATERIAL="));
      std::string text(StlColors::kMark);
      if (at < whole.size()) text += whole.substr(at, 30);
      text.resize(80);
      std::memcpy(header.data(), text.data(), text.size());
    }
    return header;
  }
  /// Whether attributes of facets are colours; the first call may read all of them.
  [[nodiscard]] bool has_colors() const {
    std::call_once(looked_, [&] {
      const StlColors colors(bytes_of_file().first(80));
      WalkWindow window(mapped(), first_triangle_);
      constexpr std::uint64_t kSome = 1 << 14;
      for (std::uint64_t t = 0; t < triangles_ && !has_colors_; t += kSome) {
        const std::size_t at = first_triangle_ + t * triangle_bytes_;
        window.reach(at);
        has_colors_ = colors.are_used(bytes_of_file().data() + at, std::min(kSome, triangles_ - t));
      }
    });
    return has_colors_;
  }
  [[nodiscard]] static std::uint32_t count_of(Bytes bytes) {
    std::uint32_t count = 0;
    std::memcpy(&count, bytes.data() + 80, sizeof(count));
    return count;
  }
  [[nodiscard]] static bool is_exact(Bytes bytes) {
    return bytes.size() >= kStlHeader &&
           bytes.size() == kStlHeader + std::size_t{count_of(bytes)} * kStlFacet;
  }

  mutable std::once_flag looked_;
  mutable bool has_colors_ = false;
};

}  // namespace

std::unique_ptr<LargeFile> open_large_stl(const std::filesystem::path& file) {
  return std::make_unique<LargeStl>(file);
}

}  // namespace rastrum::io
