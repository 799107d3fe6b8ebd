// SPDX-License-Identifier: BSD-3-Clause
// NPY 1.0: a header, the rows.
#include <string>
#include <type_traits>

#include <rastrum/io/mapped_file.hpp>
#include <rastrum/io/npy_header.hpp>
#include <rastrum/io/rows.hpp>

namespace rastrum::io {
namespace {

template <class Pixel>
class NpyRows final : public RowsOf<Pixel> {
 public:
  NpyRows(AtomicFile& out, int width, int height) : out_(out) {
    constexpr std::size_t kBytes = std::is_integral_v<Pixel> ? sizeof(Pixel) : sizeof(float);
    std::string type(kLittleEndian ? "<" : ">");
    type.append(std::is_integral_v<Pixel> ? "i" : "f").append(std::to_string(kBytes));
    std::string shape("(");
    shape.append(std::to_string(height)).append(", ").append(std::to_string(width));
    if (sizeof(Pixel) != kBytes) shape.append(", ").append(std::to_string(sizeof(Pixel) / kBytes));
    const std::string header = npy_header_text(type, shape.append(")"));
    out.write(header.data(), header.size());
  }
  void add(ImageView<const Pixel> rows) override {
    for (int y = 0; y < rows.height; ++y)
      out_.write(rows.row(y), static_cast<std::size_t>(rows.width) * sizeof(Pixel));
  }

 private:
  AtomicFile& out_;
};

}  // namespace

template <class Pixel>
std::unique_ptr<RowsOf<Pixel>> npy_rows(AtomicFile& out, int width, int height) {
  return std::make_unique<NpyRows<Pixel>>(out, width, height);
}

void write_npy(AtomicFile& out, ImageView<const Vec4> image) {
  write_whole(out, image, npy_rows<Vec4>);
}

void write_npy(AtomicFile& out, ImageView<const Vec3> image) {
  write_whole(out, image, npy_rows<Vec3>);
}

void write_npy(AtomicFile& out, ImageView<const Vec2> image) {
  write_whole(out, image, npy_rows<Vec2>);
}

void write_npy(AtomicFile& out, ImageView<const float> image) {
  write_whole(out, image, npy_rows<float>);
}

void write_npy(AtomicFile& out, ImageView<const std::int64_t> image) {
  write_whole(out, image, npy_rows<std::int64_t>);
}

void write_npy(AtomicFile& out, ImageView<const std::int32_t> image) {
  write_whole(out, image, npy_rows<std::int32_t>);
}

template std::unique_ptr<RowsOf<Vec4>> npy_rows<Vec4>(AtomicFile&, int, int);
template std::unique_ptr<RowsOf<Vec3>> npy_rows<Vec3>(AtomicFile&, int, int);
template std::unique_ptr<RowsOf<Vec2>> npy_rows<Vec2>(AtomicFile&, int, int);
template std::unique_ptr<RowsOf<float>> npy_rows<float>(AtomicFile&, int, int);
template std::unique_ptr<RowsOf<std::int64_t>> npy_rows<std::int64_t>(AtomicFile&, int, int);
template std::unique_ptr<RowsOf<std::int32_t>> npy_rows<std::int32_t>(AtomicFile&, int, int);

}  // namespace rastrum::io
