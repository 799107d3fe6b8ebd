// SPDX-License-Identifier: BSD-3-Clause
// Numbers on geometry, which become colours (color_map.hpp): what a measurement or a simulation has
// found at each vertex, face, point or instance.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include <rastrum/array.hpp>
#include <rastrum/config.hpp>

namespace RASTRUM_API rastrum {

/// The element to which each value of an attribute belongs.
enum class Per : std::uint8_t { vertex, corner, face, mesh };

template <class C>
concept ScalarNumber = std::same_as<C, float> || std::same_as<C, double> || IndexNumber<C>;

namespace array_detail {
template <class R>
concept Scalars = Contiguous<R> && ScalarNumber<ElementOf<R>>;
}  // namespace array_detail

/// Numbers of any type in a caller's memory, read as float64 as they are: integers are not
/// normalized (those of 64 bits are rounded to nearest). Strides and null follow ArrayView's rules.
class ScalarView {
 public:
  ScalarView() = default;
  /// Vectors, arrays and spans of numbers.
  template <array_detail::Scalars R>
  requires array_detail::Lasting<R> ScalarView(R&& numbers)
      : ScalarView(of(std::span(numbers).data(), std::span(numbers).size())) {}
  template <array_detail::Scalars R>
  ScalarView(R&&) = delete;  // this array ends before its view does: give it a name first

  /// `count` numbers: float, double or integers of any size.
  template <ScalarNumber C>
  [[nodiscard]] static ScalarView of(const C* numbers, std::size_t count,
                                     std::ptrdiff_t stride_bytes = sizeof(C)) {
    ScalarView v;
    v.data_ = array_detail::values_at(numbers, count);
    v.size_ = count;
    v.stride_ = stride_bytes;
    v.type_ = type_of<C>();
    return v;
  }
  /// Views numbers in a buffer. Throws Error{invalid_argument} if one of them reaches beyond it, or
  /// the layout has more than one number a value.
  [[nodiscard]] static ScalarView in(std::span<const std::byte> buffer, const ArrayLayout& layout);

  [[nodiscard]] RASTRUM_HD std::size_t size() const { return size_; }
  [[nodiscard]] RASTRUM_HD bool empty() const { return size_ == 0; }
  /// The number at index i < size().
  [[nodiscard]] double operator[](std::size_t i) const;

  /// The memory that it views.
  [[nodiscard]] std::span<const std::byte> reach() const {
    return array_detail::reach(data_, size_, stride_, 1);
  }

  /// Whether both view the same memory in the same way.
  bool operator==(const ScalarView&) const = default;

 private:
  template <class C>
  static constexpr NumberType type_of() {
    if constexpr (std::same_as<C, float>) return NumberType::float32;
    if constexpr (std::same_as<C, double>) return NumberType::float64;
    if constexpr (std::integral<C>) {
      constexpr bool s = std::is_signed_v<C>;
      if constexpr (sizeof(C) == 1) return s ? NumberType::int8 : NumberType::uint8;
      if constexpr (sizeof(C) == 2) return s ? NumberType::int16 : NumberType::uint16;
      if constexpr (sizeof(C) == 4) return s ? NumberType::int32 : NumberType::uint32;
      if constexpr (sizeof(C) == 8) return s ? NumberType::int64 : NumberType::uint64;
    }
  }

  const std::byte* data_ = nullptr;
  std::size_t size_ = 0;
  std::ptrdiff_t stride_ = sizeof(float);
  NumberType type_ = NumberType::float32;
};

/// The scalars of a mesh; empty: it has none.
struct MeshScalarsView {
  ScalarView values{};
  Per per = Per::vertex;

  bool operator==(const MeshScalarsView&) const = default;
  [[nodiscard]] RASTRUM_HD bool empty() const { return values.empty(); }
};

/// Numbers that a geometry owns. Geometries other than meshes have one a position, sphere or disc.
struct NamedScalars {
  std::string name{};
  std::vector<double> values{};
  Per per = Per::vertex;
};

}  // namespace rastrum
