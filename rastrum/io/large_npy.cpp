// SPDX-License-Identifier: BSD-3-Clause
// NPY out of core: triangles, (n, 3, 3) or (n, 9), drawn in place. A chunk converts float64 corners
// to be rounded (wide_positions.hpp).
#include <string>

#include <rastrum/io/large_soup.hpp>
#include <rastrum/io/npy_header.hpp>

namespace rastrum::io {
namespace {

class LargeNpy final : public LargeSoup {
 public:
  explicit LargeNpy(const std::filesystem::path& file) : LargeSoup(file) {
    if constexpr (!kLittleEndian) refuse("its numbers are not in this machine's order");
    const NpyTriangles found = parse_npy_triangles(bytes_of_file(), name_);
    triangles_ = found.count;
    vertices_ = 3 * triangles_;
    first_triangle_ = found.header.data;
    triangle_bytes_ = found.bytes_each();
    wide_ = found.wide;
    far_ =
        wide_ && (found.header.keeps_float64 || lie_far(first_triangle_, sizeof(Vec3d), vertices_));
  }

 private:
  [[nodiscard]] std::vector<std::byte> header_of(std::size_t triangles) const override {
    std::string shape = std::string("(").append(std::to_string(triangles)).append(", 9)");
    if (far_) shape.append(", ").append(kKeepsFloat64);
    const std::string text = npy_header_text(far_ ? "<f8" : "<f4", shape);
    const auto bytes = std::as_bytes(std::span(text));
    return {bytes.begin(), bytes.end()};
  }
};

}  // namespace

std::unique_ptr<LargeFile> open_large_npy(const std::filesystem::path& file) {
  return std::make_unique<LargeNpy>(file);
}

}  // namespace rastrum::io
