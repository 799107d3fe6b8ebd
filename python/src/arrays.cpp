// SPDX-License-Identifier: BSD-3-Clause
// Python's arrays as the renderer's views, never a copy.
#include <algorithm>
#include <span>

#include "bindings.hpp"

namespace rastrum::python {
namespace {

[[noreturn]] void refuse(const char* name, const std::string& why) {
  throw Error(Errc::invalid_argument, std::string(name) + ": " + why);
}

std::string text(const nb::dlpack::dtype& type) {
  const char* const kinds[] = {"int", "uint", "float", "?", "bfloat", "complex", "bool"};
  const std::string bits = type.code == 6 ? "" : std::to_string(type.bits);
  return (type.code < 7 ? kinds[type.code] : "?") + bits;
}

NumberType number_type(const Array& array, const char* name) {
  const nb::dlpack::dtype type = array.dtype();
  using Code = nb::dlpack::dtype_code;
  if (type.lanes == 1) {
    const auto is = [&](Code code, int bits) {
      return type.code == static_cast<std::uint8_t>(code) && type.bits == bits;
    };
    if (is(Code::Float, 32)) return NumberType::float32;
    if (is(Code::Float, 64)) return NumberType::float64;
    if (is(Code::UInt, 8)) return NumberType::uint8;
    if (is(Code::Int, 8)) return NumberType::int8;
    if (is(Code::UInt, 16)) return NumberType::uint16;
    if (is(Code::Int, 16)) return NumberType::int16;
    if (is(Code::UInt, 32)) return NumberType::uint32;
    if (is(Code::Int, 32)) return NumberType::int32;
    if (is(Code::UInt, 64)) return NumberType::uint64;
    if (is(Code::Int, 64)) return NumberType::int64;
  }
  refuse(name,
         "numbers of type " + text(type) + " cannot be drawn; take float32, float64 or integers");
}

std::string shape_of(const Array& array) {
  std::string s = "(";
  for (std::size_t i = 0; i < array.ndim(); ++i)
    s += (i > 0 ? ", " : "") + std::to_string(array.shape(i));
  return s + (array.ndim() == 1 ? ",)" : ")");
}

/// `count` values of `channels` numbers, `stride` bytes apart, as a buffer of just these.
struct ArrayBuffer {
  std::span<const std::byte> bytes;
  ArrayLayout layout;

  ArrayBuffer(const Array& array, NumberType type, int channels, std::size_t count,
              std::ptrdiff_t stride) {
    const auto* const first = static_cast<const std::byte*>(array.data());
    const std::size_t value = bytes_of(type) * static_cast<std::size_t>(channels);
    const std::ptrdiff_t last = count == 0 ? 0 : static_cast<std::ptrdiff_t>(count - 1) * stride;
    const std::ptrdiff_t low = std::min<std::ptrdiff_t>(0, last);
    const std::size_t size =
        count == 0 ? 0 : static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, last) - low) + value;
    bytes = {first + low, size};
    layout = {type, channels, count, static_cast<std::size_t>(-low), stride};
  }
};

std::ptrdiff_t stride_bytes(const Array& array, std::size_t axis, NumberType type) {
  return static_cast<std::ptrdiff_t>(array.stride(axis)) *
         static_cast<std::ptrdiff_t>(bytes_of(type));
}

}  // namespace

template <ViewedValue T>
ArrayView<T> values(const Array& array, const char* name) {
  constexpr int kChannels = array_detail::kChannels<T>;
  const NumberType type = number_type(array, name);
  int channels = 1;
  if constexpr (kChannels == 1) {
    if (array.ndim() != 1) refuse(name, "the shape is " + shape_of(array) + " and must be (N,)");
  } else {
    const bool rgb = kChannels == 4 && array.ndim() == 2 && array.shape(1) == 3;
    if (array.ndim() != 2 || (array.shape(1) != kChannels && !rgb))
      refuse(name, "the shape is " + shape_of(array) + " and must be (N, " +
                       (kChannels == 4 ? "3 or 4" : std::to_string(kChannels)) + ")");
    channels = static_cast<int>(array.shape(1));
    if (array.shape(0) > 0 && array.stride(1) != 1)
      refuse(name,
             "the numbers of a value lie apart; numpy.ascontiguousarray makes a copy in which they "
             "do not");
  }
  const std::size_t count = array.shape(0);
  if (count == 0) return {};
  const ArrayBuffer buffer(array, type, channels, count, stride_bytes(array, 0, type));
  return ArrayView<T>::in(buffer.bytes, buffer.layout);
}
template ArrayView<float> values(const Array&, const char*);
template ArrayView<Vec2> values(const Array&, const char*);
template ArrayView<Vec3> values(const Array&, const char*);
template ArrayView<Vec4> values(const Array&, const char*);

ScalarView scalars(const Array& array, const char* name) {
  const NumberType type = number_type(array, name);
  if (array.ndim() != 1) refuse(name, "the shape is " + shape_of(array) + " and must be (N,)");
  const std::size_t count = array.shape(0);
  if (count == 0) return {};
  const ArrayBuffer buffer(array, type, 1, count, stride_bytes(array, 0, type));
  return ScalarView::in(buffer.bytes, buffer.layout);
}

IndexView indices(const Array& array, const char* name) {
  const NumberType type = number_type(array, name);
  if (type == NumberType::float32 || type == NumberType::float64)
    refuse(name, "indices must be integers, not " + text(array.dtype()));
  if (array.ndim() != 1 && array.ndim() != 2)
    refuse(name, "the shape is " + shape_of(array) + " and must be (N,) or (M, K)");
  std::size_t count = array.shape(0);
  std::ptrdiff_t stride = stride_bytes(array, array.ndim() - 1, type);
  if (array.ndim() == 2) {
    count *= array.shape(1);
    if (array.shape(1) == 1) stride = stride_bytes(array, 0, type);
    if (array.shape(0) > 1 && array.shape(1) > 1 &&
        stride_bytes(array, 0, type) != stride * static_cast<std::ptrdiff_t>(array.shape(1)))
      refuse(name, "the rows lie apart; numpy.ascontiguousarray makes a copy in which they do not");
  }
  if (count == 0) return {};
  const ArrayBuffer buffer(array, type, 1, count, stride);
  return IndexView::in(buffer.bytes, buffer.layout);
}

Mat4d matrix(const Array& array, const char* name) {
  if (array.ndim() != 2 || (array.shape(0) != 4 && array.shape(0) != 3) || array.shape(1) != 4 ||
      array.dtype() != nb::dtype<double>())
    refuse(name, "the shape is " + shape_of(array) + " of " + text(array.dtype()) +
                     " and must be (4, 4) or (3, 4) of float64");
  Mat4d m = Mat4d::identity();
  for (std::size_t i = 0; i < array.shape(0); ++i)
    for (std::size_t j = 0; j < 4; ++j)
      m.m[i][j] =
          static_cast<const double*>(array.data())[static_cast<std::int64_t>(i) * array.stride(0) +
                                                   static_cast<std::int64_t>(j) * array.stride(1)];
  return m;
}

}  // namespace rastrum::python
