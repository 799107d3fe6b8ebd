// Binary STL out of core. A facet has its corners side by side, behind a normal that nobody reads;
// a chunk copies them, 36 bytes of 50.
#include <bit>
#include <cstring>
#include <string>

#include <rastrum/io/large_soup.hpp>

namespace rastrum::io {
namespace {

constexpr std::size_t kStlHeader = 84, kStlFacet = 50, kStlCorners = 12;

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

 private:
  [[nodiscard]] std::vector<std::byte> header_of(std::size_t triangles) const override {
    std::vector<std::byte> header(kStlHeader);
    std::memcpy(header.data(), bytes_of_file().data(), kStlHeader);
    const auto count = static_cast<std::uint32_t>(triangles);
    std::memcpy(header.data() + 80, &count, sizeof(count));
    return header;
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
};

}  // namespace

std::unique_ptr<LargeFile> open_large_stl(const std::filesystem::path& file) {
  return std::make_unique<LargeStl>(file);
}

}  // namespace rastrum::io
