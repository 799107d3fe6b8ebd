// SPDX-License-Identifier: BSD-3-Clause
// Binary STL out of core. A chunk copies a facet's corners, 36 bytes of 50. Its normal is not read.
#include <algorithm>
#include <cstring>
#include <mutex>
#include <string>

#include <rastrum/io/binary_stl.hpp>
#include <rastrum/io/large_soup.hpp>

namespace rastrum::io {
namespace {

class LargeStl final : public LargeSoup {
 public:
  explicit LargeStl(const std::filesystem::path& file) : LargeSoup(file) {
    const Bytes bytes = bytes_of_file();
    if (as_text(bytes).starts_with("solid") && !stl::is_exact(bytes))
      refuse("it seems to be text; write it as binary STL");
    triangles_ = stl::facet_count(bytes, [&](const std::string& why) { fail(why); });
    if constexpr (!kLittleEndian) refuse("its numbers are not in this machine's order");
    vertices_ = 3 * triangles_;
    first_triangle_ = stl::kHeader;
    triangle_bytes_ = stl::kFacet;
    corners_ = stl::kCorners;
  }

  /// With colours, an index per corner and a colour.
  [[nodiscard]] std::uint64_t bytes_a_triangle() const override {
    return LargeSoup::bytes_a_triangle() + (has_colors() ? 16 + 16 : 0);
  }

 private:
  [[nodiscard]] std::vector<std::byte> header_of(std::size_t triangles) const override {
    const Bytes whole_header = bytes_of_file().first(stl::kHeader);
    std::vector<std::byte> header(whole_header.begin(), whole_header.end());
    const auto count = static_cast<std::uint32_t>(triangles);
    std::memcpy(header.data() + 80, &count, sizeof(count));
    if (has_colors()) {
      // The selected facets alone might not show that attributes are colours.
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
  /// Whether attributes of facets are colours. The first call may read all of them.
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

  mutable std::once_flag looked_;
  mutable bool has_colors_ = false;
};

}  // namespace

std::unique_ptr<LargeFile> open_large_stl(const std::filesystem::path& file) {
  return std::make_unique<LargeStl>(file);
}

}  // namespace rastrum::io
