// SPDX-License-Identifier: BSD-3-Clause
// Chooses a picture's writer of bands, by the format and the first pixels.
#include <string>
#include <variant>

#include <rastrum/error.hpp>
#include <rastrum/io/rows.hpp>

namespace rastrum::io {
namespace {

template <class... Pixel>
using AnyRows = std::variant<std::monostate, std::unique_ptr<RowsOf<Pixel>>...>;

}  // namespace

struct PictureRows::Impl {
  AtomicFile& out;
  Format format;
  int width, height, threads;
  int done = 0;
  AnyRows<Rgba8, Vec4, Vec3, Vec2, float, std::int64_t, std::int32_t> rows{};

  [[noreturn]] void refuse(const std::string& what) const {
    throw Error(Errc::invalid_argument, out.name() + ": " + what);
  }

  template <class Pixel>
  std::unique_ptr<RowsOf<Pixel>> make() {
    if constexpr (std::is_same_v<Pixel, Rgba8>) {
      if (format == Format::png) return png_rows(out, width, height, threads);
    } else {
      if constexpr (std::is_same_v<Pixel, Vec4> || std::is_same_v<Pixel, Vec3> ||
                    std::is_same_v<Pixel, float>)
        if (format == Format::exr) return exr_rows<Pixel>(out, width, height);
      if (format == Format::npy) return npy_rows<Pixel>(out, width, height);
    }
    refuse("pixels of this kind are not written in its format");
  }

  template <class Pixel>
  void add(ImageView<const Pixel> band) {
    check_picture(out, band);
    if (band.width != width || band.height > height - done)
      refuse("rows of " + std::to_string(band.width) + " pixels, " + std::to_string(band.height) +
             " of them after " + std::to_string(done) + ", in a picture of " +
             std::to_string(width) + "x" + std::to_string(height));
    if (std::holds_alternative<std::monostate>(rows)) rows = make<Pixel>();
    auto* const of = std::get_if<std::unique_ptr<RowsOf<Pixel>>>(&rows);
    if (of == nullptr) refuse("rows of another kind of pixels than the first");
    (*of)->add(band);
    done += band.height;
  }
};

PictureRows::PictureRows(AtomicFile& out, Format format, int width, int height, int threads)
    : impl_("PictureRows", std::unique_ptr<Impl>(new Impl{out, format, width, height, threads})) {
  if (width < 1 || height < 1 || width > kMaxImageSize || height > kMaxImageSize)
    impl_->refuse("image size " + std::to_string(width) + "x" + std::to_string(height) +
                  " is outside 1x1 to 32768x32768");
}
PictureRows::PictureRows(PictureRows&&) noexcept = default;
PictureRows::~PictureRows() = default;

void PictureRows::add(ImageView<const Rgba8> rows) {
  impl_->add(rows);
}
void PictureRows::add(ImageView<const Vec4> rows) {
  impl_->add(rows);
}
void PictureRows::add(ImageView<const Vec3> rows) {
  impl_->add(rows);
}
void PictureRows::add(ImageView<const Vec2> rows) {
  impl_->add(rows);
}
void PictureRows::add(ImageView<const float> rows) {
  impl_->add(rows);
}
void PictureRows::add(ImageView<const std::int64_t> rows) {
  impl_->add(rows);
}
void PictureRows::add(ImageView<const std::int32_t> rows) {
  impl_->add(rows);
}

void PictureRows::finish() {
  if (impl_->done != impl_->height)
    impl_->refuse(std::to_string(impl_->done) + " of " + std::to_string(impl_->height) +
                  " rows have come");
  std::visit(
      [](auto& of) {
        if constexpr (!std::is_same_v<std::remove_cvref_t<decltype(of)>, std::monostate>)
          of->finish();
      },
      impl_->rows);
}

}  // namespace rastrum::io
