// SPDX-License-Identifier: BSD-3-Clause
// The rows of images in memory: checks that a view can be filled, and that images and arrays do not
// overlap, where one would destroy the other.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include <rastrum/error.hpp>
#include <rastrum/image.hpp>

namespace rastrum {

/// Throws Error{invalid_argument} that begins with `name` if the view's rows overlap, or if it has
/// a size but no pixels.
template <class T>
void check_stride(const ImageView<T>& view, const std::string& name) {
  if (view.empty() && view.width != 0 && view.height != 0)
    throw Error(Errc::invalid_argument, name + " has its " + std::to_string(view.width) + "x" +
                                            std::to_string(view.height) +
                                            " pixels at a null pointer; give where they lie, or "
                                            "an ImageView{} for none");
  const std::ptrdiff_t apart = view.stride < 0 ? -view.stride : view.stride;
  if (!view.empty() && apart < view.width)
    throw Error(Errc::invalid_argument,
                name + ": rows of " + std::to_string(view.width) +
                    " pixels overlap with a stride of " + std::to_string(view.stride) +
                    "; make the view as {data, width, height}, or give the elements from a row to "
                    "the next (negative: from the bottom up)");
}

/// check_stride, and refuses a non-empty view that is not width × height.
template <class T>
void check_size(const ImageView<T>& view, int width, int height, const std::string& name) {
  if (view.empty()) return check_stride(view, name);
  if (view.width != width || view.height != height)
    throw Error(Errc::invalid_argument, name + " is " + std::to_string(view.width) + "x" +
                                            std::to_string(view.height) + " and must be " +
                                            std::to_string(width) + "x" + std::to_string(height) +
                                            ", as the frame is");
  check_stride(view, name);
}

/// The rows of an image by ascending address; they do not overlap (check_stride).
struct ViewRows {
  const std::byte* first = nullptr;
  std::size_t row_bytes = 0, rows = 0;
  std::size_t stride_bytes = 0;  ///< from row to row

  template <class T>
  [[nodiscard]] static ViewRows of(const ImageView<T>& view) {
    if (view.empty() || view.width < 1 || view.height < 1) return {};
    const std::ptrdiff_t stride = view.stride * static_cast<std::ptrdiff_t>(sizeof(T));
    const T* const lowest = stride < 0 ? view.row(view.height - 1) : view.data;
    return {static_cast<const std::byte*>(static_cast<const void*>(lowest)),
            static_cast<std::size_t>(view.width) * sizeof(T), static_cast<std::size_t>(view.height),
            static_cast<std::size_t>(stride < 0 ? -stride : stride)};
  }
  [[nodiscard]] static ViewRows of(std::span<const std::byte> bytes) {
    return {bytes.data(), bytes.size(), bytes.empty() ? std::size_t{0} : 1, 0};
  }
};

/// Whether they share a byte. O(1) if one lies behind the other, else O(rows).
[[nodiscard]] bool overlap(const ViewRows& a, const ViewRows& b) noexcept;

/// Throws Error{invalid_argument} that names both if they overlap.
template <class A, class B>
void check_apart(const ImageView<A>& a, const char* name_a, const ImageView<B>& b,
                 const char* name_b) {
  if (overlap(ViewRows::of(a), ViewRows::of(b)))
    throw Error(Errc::invalid_argument, std::string(name_a).append(" and ").append(name_b).append(
                                            " overlap in memory; give each its own"));
}

}  // namespace rastrum
