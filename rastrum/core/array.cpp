// SPDX-License-Identifier: BSD-3-Clause
// Reads values of each type: the one place where types become code.
#include <rastrum/array.hpp>
#include <rastrum/scalars.hpp>

#include <algorithm>

#include <rastrum/error.hpp>

namespace rastrum {
namespace array_detail {
namespace {

template <class C>
C load(const std::byte* from) {
  C value;
  std::memcpy(&value, from, sizeof value);
  return value;
}

/// As float32; float64 stays as it is.
template <class C>
auto number(C c) {
  if constexpr (std::is_floating_point_v<C>) {
    return c;
  } else {
    constexpr float kMost = std::numeric_limits<C>::max();
    const float scaled = static_cast<float>(c) / kMost;
    return std::is_signed_v<C> && scaled < -1 ? -1.0F : scaled;
  }
}

/// The value at `from`; To is T or Wide<T>.
template <class To, class C, int channels>
To value(const std::byte* from) {
  using Number = std::conditional_t<std::same_as<To, Vec3d>, double, float>;
  const auto channel = [&](int i) {
    return i < channels ? static_cast<Number>(
                              number(load<C>(from + static_cast<std::ptrdiff_t>(sizeof(C)) * i)))
                        : Number{1};
  };
  if constexpr (std::same_as<To, float>)
    return channel(0);
  else if constexpr (std::same_as<To, Vec2>)
    return {channel(0), channel(1)};
  else if constexpr (std::same_as<To, Vec4>)
    return {channel(0), channel(1), channel(2), channel(3)};
  else
    return {channel(0), channel(1), channel(2)};
}

template <class To, class C, int channels>
void run(const std::byte* first, std::ptrdiff_t stride, std::size_t n, To* out) {
  for (std::size_t i = 0; i < n; ++i, first += stride) out[i] = value<To, C, channels>(first);
}

template <class To, class C, int channels>
void gather(const std::byte* first, std::ptrdiff_t stride, const std::uint32_t* indices,
            std::size_t n, To* out) {
  for (std::size_t i = 0; i < n; ++i)
    out[i] = value<To, C, channels>(first + static_cast<std::ptrdiff_t>(indices[i]) * stride);
}

template <class T, class C, int channels>
constexpr Reader<T> kReader{std::same_as<C, double>,     value<T, C, channels>,
                            value<Wide<T>, C, channels>, run<T, C, channels>,
                            run<Wide<T>, C, channels>,   gather<T, C, channels>,
                            gather<Wide<T>, C, channels>};

template <class C>
std::uint64_t index_at(const std::byte* from) {
  return static_cast<std::uint64_t>(load<C>(from));
}

template <class C>
void index_run(const std::byte* first, std::ptrdiff_t stride, std::size_t n, std::uint32_t* out) {
  for (std::size_t i = 0; i < n; ++i, first += stride)
    out[i] = static_cast<std::uint32_t>(std::min<std::uint64_t>(index_at<C>(first), kNoIndex));
}

std::ptrdiff_t stride_of(const ArrayLayout& l) {
  const std::size_t packed = bytes_of(l.type) * static_cast<std::size_t>(l.channels);
  return l.stride_bytes.value_or(static_cast<std::ptrdiff_t>(packed));
}

/// The address of the first value. Throws if any value reaches beyond `buffer`. Compares before it
/// multiplies, so that nothing overflows.
const void* first_within(std::span<const std::byte> buffer, const ArrayLayout& l) {
  if (l.count == 0) return buffer.data();
  const std::size_t size = buffer.size();
  const std::size_t value = bytes_of(l.type) * static_cast<std::size_t>(l.channels);
  const std::ptrdiff_t stride = stride_of(l);
  const auto step = stride < 0 ? std::uint64_t{0} - static_cast<std::uint64_t>(stride)
                               : static_cast<std::uint64_t>(stride);
  // The farthest that the last value may lie from the first.
  std::uint64_t reach = 0;
  bool ok = value <= size && l.offset_bytes <= size - value;
  if (ok) reach = stride < 0 ? l.offset_bytes : size - value - l.offset_bytes;
  ok = ok && (step == 0 || l.count - 1 <= reach / step);
  if (!ok)
    throw Error(Errc::invalid_argument,
                "array: " + std::to_string(l.count) + " values of " + std::to_string(value) +
                    " bytes from byte " + std::to_string(l.offset_bytes) + " on, every " +
                    std::to_string(stride) + " bytes, reach beyond a buffer of " +
                    std::to_string(size) + " bytes");
  return buffer.data() + l.offset_bytes;
}

}  // namespace

void refuse_null(std::size_t count) {
  throw Error(Errc::invalid_argument, "array: a view of " + std::to_string(count) +
                                          " values at a null pointer; give where they lie, or a "
                                          "count of 0");
}

void refuse_flat(std::size_t numbers, int a_value) {
  throw Error(Errc::invalid_argument,
              "array: " + std::to_string(numbers) +
                  " numbers do not make up whole values, which have " + std::to_string(a_value) +
                  " each; " +
                  (a_value == 4 && numbers % 3 == 0 ? "colours without alpha are ArrayView::rgb"
                                                    : "ArrayView::of takes a count and a stride"));
}

template <class T, class C>
const Reader<T>& reader(int channels) noexcept {
  if constexpr (std::same_as<T, Vec4>)
    if (channels == 3) return kReader<T, C, 3>;
  return kReader<T, C, kChannels<T>>;
}

template <class C>
const IndexReader& index_reader() noexcept {
  static constexpr IndexReader kReader{std::is_signed_v<C>, sizeof(C), index_at<C>, index_run<C>};
  return kReader;
}

template const IndexReader& index_reader<std::uint8_t>() noexcept;
template const IndexReader& index_reader<std::int8_t>() noexcept;
template const IndexReader& index_reader<std::uint16_t>() noexcept;
template const IndexReader& index_reader<std::int16_t>() noexcept;
template const IndexReader& index_reader<std::uint32_t>() noexcept;
template const IndexReader& index_reader<std::int32_t>() noexcept;
template const IndexReader& index_reader<std::uint64_t>() noexcept;
template const IndexReader& index_reader<std::int64_t>() noexcept;

}  // namespace array_detail

namespace {

/// Returns f(a number of this type), or f(nullptr) for a value that the enum lacks.
template <class F>
auto visit_type(NumberType type, const F& f) {
  switch (type) {
    case NumberType::float32:
      return f(float{});
    case NumberType::float64:
      return f(double{});
    case NumberType::uint8:
      return f(std::uint8_t{});
    case NumberType::int8:
      return f(std::int8_t{});
    case NumberType::uint16:
      return f(std::uint16_t{});
    case NumberType::int16:
      return f(std::int16_t{});
    case NumberType::uint32:
      return f(std::uint32_t{});
    case NumberType::int32:
      return f(std::int32_t{});
    case NumberType::uint64:
      return f(std::uint64_t{});
    case NumberType::int64:
      return f(std::int64_t{});
  }
  return f(nullptr);
}

}  // namespace

std::size_t bytes_of(NumberType type) noexcept {
  return visit_type(
      type, []<class C>(C) -> std::size_t { return std::is_null_pointer_v<C> ? 0 : sizeof(C); });
}

template <ViewedValue T>
ArrayView<T> ArrayView<T>::in(std::span<const std::byte> buffer, const ArrayLayout& l) {
  constexpr int kWanted = array_detail::kChannels<T>;
  if (l.channels != kWanted && !(std::same_as<T, Vec4> && l.channels == 3))
    throw Error(Errc::invalid_argument, "array: values have " + std::to_string(kWanted) +
                                            " channels, not " + std::to_string(l.channels));
  return visit_type(l.type, [&]<class C>(C) -> ArrayView {
    if constexpr (std::is_floating_point_v<C> || (std::is_integral_v<C> && sizeof(C) <= 2)) {
      const void* const first = array_detail::first_within(buffer, l);
      return ArrayView(static_cast<const C*>(first), l.channels, l.count,
                       array_detail::stride_of(l));
    } else {
      throw Error(Errc::invalid_argument,
                  "array: values are float32, float64 or normalized integers of 8 or 16 bits");
    }
  });
}

#define RASTRUM_READERS(T)                                                                      \
  template ArrayView<T> ArrayView<T>::in(std::span<const std::byte>, const ArrayLayout&);       \
  template const array_detail::Reader<T>& array_detail::reader<T, float>(int) noexcept;         \
  template const array_detail::Reader<T>& array_detail::reader<T, double>(int) noexcept;        \
  template const array_detail::Reader<T>& array_detail::reader<T, std::uint8_t>(int) noexcept;  \
  template const array_detail::Reader<T>& array_detail::reader<T, std::int8_t>(int) noexcept;   \
  template const array_detail::Reader<T>& array_detail::reader<T, std::uint16_t>(int) noexcept; \
  template const array_detail::Reader<T>& array_detail::reader<T, std::int16_t>(int) noexcept;
RASTRUM_READERS(float)
RASTRUM_READERS(Vec2)
RASTRUM_READERS(Vec3)
RASTRUM_READERS(Vec4)
#undef RASTRUM_READERS

IndexView IndexView::in(std::span<const std::byte> buffer, const ArrayLayout& l) {
  if (l.channels != 1)
    throw Error(Errc::invalid_argument,
                "array: indices have one channel, not " + std::to_string(l.channels));
  return visit_type(l.type, [&]<class C>(C) -> IndexView {
    if constexpr (std::is_integral_v<C>) {
      const void* const first = array_detail::first_within(buffer, l);
      return of(static_cast<const C*>(first), l.count, array_detail::stride_of(l));
    } else {
      throw Error(Errc::invalid_argument, "array: indices are integers");
    }
  });
}

ScalarView ScalarView::in(std::span<const std::byte> buffer, const ArrayLayout& l) {
  if (l.channels != 1)
    throw Error(Errc::invalid_argument,
                "array: scalars have one channel, not " + std::to_string(l.channels));
  return visit_type(l.type, [&]<class C>(C) -> ScalarView {
    if constexpr (std::is_arithmetic_v<C>)
      return of(static_cast<const C*>(array_detail::first_within(buffer, l)), l.count,
                array_detail::stride_of(l));
    else
      throw Error(Errc::invalid_argument, "array: the type is none");
  });
}

double ScalarView::operator[](std::size_t i) const {
  const std::byte* const at = data_ + static_cast<std::ptrdiff_t>(i) * stride_;
  return visit_type(type_, [&]<class C>(C) -> double {
    if constexpr (std::is_arithmetic_v<C>) {
      C value;
      std::memcpy(&value, at, sizeof value);
      return static_cast<double>(value);
    } else {
      return 0;
    }
  });
}

std::string IndexView::text(std::size_t i) const {
  const std::uint64_t bits = wide(i);
  return reader_ != nullptr && reader_->is_signed ? std::to_string(static_cast<std::int64_t>(bits))
                                                  : std::to_string(bits);
}

}  // namespace rastrum
