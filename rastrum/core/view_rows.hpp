// The rows of images in memory, and whether they overlap: if two images do, or an image and an
// array, one destroys the other.
#pragma once

#include <cstddef>
#include <span>

#include <rastrum/image.hpp>

namespace rastrum {

/// The rows of an image, those at lower addresses first; they do not overlap (check_stride).
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

/// Whether both contain the same byte. O(1) if one lies behind the other, else O(rows).
[[nodiscard]] bool overlap(const ViewRows& a, const ViewRows& b) noexcept;

/// Throws Error{invalid_argument} that names both where they overlap.
template <class A, class B>
void check_apart(const ImageView<A>& a, const char* name_a, const ImageView<B>& b,
                 const char* name_b) {
  if (overlap(ViewRows::of(a), ViewRows::of(b)))
    throw Error(Errc::invalid_argument, std::string(name_a).append(" and ").append(name_b).append(
                                            " overlap in memory; give each its own"));
}

}  // namespace rastrum
