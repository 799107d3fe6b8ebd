// Images: row 0 at the top, rows contiguous, pixel (x, y) at index y · width + x.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include <rastrum/core/error.hpp>
#include <rastrum/core/vec.hpp>

namespace rastrum {

inline constexpr int kMaxImageSize = 32768;

/// Straight (not premultiplied) alpha, 8 bit.
struct Rgba8 {
  std::uint8_t r = 0, g = 0, b = 0, a = 0;
  friend bool operator==(const Rgba8&, const Rgba8&) = default;
};
static_assert(sizeof(Rgba8) == 4);

/// A borrowed image. Trivially copyable; does not own.
template <class T>
struct ImageView {
  T* data = nullptr;
  int width = 0, height = 0;
  std::ptrdiff_t stride = 0;  ///< elements from a row to the next

  [[nodiscard]] RASTRUM_HD bool empty() const { return data == nullptr; }
  [[nodiscard]] RASTRUM_HD T* row(int y) const { return data + y * stride; }
  [[nodiscard]] RASTRUM_HD T& operator()(int x, int y) const { return data[y * stride + x]; }
  /// To read what may also be written. (A template, for nvcc warns of conversions to the same
  /// type.)
  template <std::same_as<const T> U>
  RASTRUM_HD operator ImageView<U>() const requires(!std::is_const_v<T>) {
    return {data, width, height, stride};
  }
};

/// An owned W × H image, value-initialized.
template <class T>
class Image {
 public:
  Image() = default;
  /// Throws Error{invalid_argument} unless 1 ≤ width, height ≤ 32,768.
  Image(int width, int height) : width_(width), height_(height) {
    if (width < 1 || height < 1 || width > kMaxImageSize || height > kMaxImageSize)
      throw Error(Errc::invalid_argument, "image size " + std::to_string(width) + "x" +
                                              std::to_string(height) +
                                              " is outside 1x1 to 32768x32768");
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

 private:
  [[nodiscard]] std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(x);
  }
  int width_ = 0, height_ = 0;
  std::vector<T> pixels_;
};

}  // namespace rastrum
