// SPDX-License-Identifier: BSD-3-Clause
// Images, with row 0 at the top. An Image has its rows one after the other, pixel (x, y) at index y
// · width + x; the rows of an ImageView may lie anywhere at equal distances.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include <rastrum/error.hpp>
#include <rastrum/vec.hpp>

namespace RASTRUM_API rastrum {

/// The largest width and height of an image, in pixels.
inline constexpr int kMaxImageSize = 32768;

/// Straight (not premultiplied) alpha, 8 bit.
struct Rgba8 {
  std::uint8_t r = 0, g = 0, b = 0, a = 0;
  friend bool operator==(const Rgba8&, const Rgba8&) = default;
};
static_assert(sizeof(Rgba8) == 4);

/// A view of an image in a caller's memory; trivially copyable. `{data, width, height}` has its
/// rows one after the other; code that sets the fields one by one must set the stride as well.
template <class T>
struct ImageView {
  T* data = nullptr;  ///< pixel (0, 0): the left one of the top row
  int width = 0, height = 0;
  /// Pixels (not bytes) from a row to the next one below: the width; or more if the picture is part
  /// of a wider one; or negative if rows lie from the bottom up (OpenGL's order, BMP), and then
  /// `data` is the row that lies last: {first + (height − 1) · width, width, height, −width}. Every
  /// function refuses a stride between −width and width.
  std::ptrdiff_t stride = width;

  [[nodiscard]] RASTRUM_HD bool empty() const { return data == nullptr; }
  [[nodiscard]] RASTRUM_HD T* row(int y) const { return data + y * stride; }
  [[nodiscard]] RASTRUM_HD T& operator()(int x, int y) const { return data[y * stride + x]; }
  /// Converts to a view that only reads. (A template: nvcc warns of conversions to the same type.)
  template <std::same_as<const T> U>
  RASTRUM_HD operator ImageView<U>() const requires(!std::is_const_v<T>) {
    return {data, width, height, stride};
  }
};

/// Throws Error{invalid_argument} unless 1 ≤ width, height ≤ 32,768.
inline void check_image_size(int width, int height) {
  if (width < 1 || height < 1 || width > kMaxImageSize || height > kMaxImageSize)
    throw Error(Errc::invalid_argument, "image size " + std::to_string(width) + "x" +
                                            std::to_string(height) +
                                            " is outside 1x1 to 32768x32768");
}

/// An owned W × H image, value-initialized.
template <class T>
class Image {
 public:
  Image() = default;
  /// Throws as check_image_size.
  Image(int width, int height) : width_(width), height_(height) {
    check_image_size(width, height);
    pixels_.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  }

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  [[nodiscard]] bool empty() const { return pixels_.empty(); }
  [[nodiscard]] std::span<T> pixels() { return pixels_; }
  [[nodiscard]] std::span<const T> pixels() const { return pixels_; }
  [[nodiscard]] T& operator()(int x, int y) { return pixels_[index(x, y)]; }
  [[nodiscard]] const T& operator()(int x, int y) const { return pixels_[index(x, y)]; }
  [[nodiscard]] ImageView<T> view() { return {pixels_.data(), width_, height_, width_}; }
  [[nodiscard]] ImageView<const T> view() const {
    return {pixels_.data(), width_, height_, width_};
  }
  /// Converts to a view; a temporary image only to one that reads.
  operator ImageView<T>() & { return view(); }
  operator ImageView<const T>() const { return view(); }

 private:
  [[nodiscard]] std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(x);
  }
  int width_ = 0, height_ = 0;
  std::vector<T> pixels_;
};

}  // namespace rastrum
