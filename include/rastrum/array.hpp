// SPDX-License-Identifier: BSD-3-Clause
// Views of values in a caller's memory, with numbers of any type and any stride. Nothing is copied,
// so the memory must outlive the view. A view decides once, when it is made, how to read its
// values: packed float32 and packed uint32 indices in place, others in runs by functions of their
// type.
#pragma once

#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>

#include <rastrum/config.hpp>
#include <rastrum/vec.hpp>

namespace RASTRUM_API rastrum {

/// The type of the numbers that values are made of.
enum class NumberType : std::uint8_t {
  float32,
  float64,
  uint8,
  int8,
  uint16,
  int16,
  uint32,
  int32,
  uint64,
  int64,
};
[[nodiscard]] std::size_t bytes_of(NumberType type) noexcept;

/// Where `count` values lie in a buffer, for callers that know the type at run time only.
struct ArrayLayout {
  NumberType type = NumberType::float32;
  int channels = 1;  ///< numbers in each value
  std::size_t count = 0;
  std::size_t offset_bytes = 0;  ///< where the first value begins
  /// Bytes from one value to the next; none: the values are packed.
  std::optional<std::ptrdiff_t> stride_bytes{};
};

/// The types of the numbers in values. float32 and float64 are taken as they are. 8 and 16 bits are
/// normalized linearly as in glTF: unsigned ones to [0, 1], signed ones to [−1, 1] (the least
/// counts as −1).
template <class C>
concept ValueNumber =
    std::same_as<C, float> || std::same_as<C, double> || std::same_as<C, std::uint8_t> ||
    std::same_as<C, std::int8_t> || std::same_as<C, std::uint16_t> || std::same_as<C, std::int16_t>;

/// The types of indices and offsets: integers of any size and sign.
template <class C>
concept IndexNumber = std::integral<C> && !std::same_as<C, bool>;

/// The types of the values in a view: float, Vec2, Vec3 or Vec4.
template <class T>
concept ViewedValue = std::same_as<T, float> || Vector<T>;

namespace array_detail {

template <class T>
inline constexpr int kChannels = static_cast<int>(sizeof(T) / sizeof(float));

/// Positions (Vec3) can be read in float64. Other values cannot, because nobody needs it.
template <class T>
using Wide = std::conditional_t<std::same_as<T, Vec3>, Vec3d, T>;

/// The functions that read values of one type.
template <class T>
struct Reader {
  bool wide;  ///< the numbers are float64
  T (*at)(const std::byte* value);
  Wide<T> (*wide_at)(const std::byte* value);
  /// Reads n values from `first` on.
  void (*run)(const std::byte* first, std::ptrdiff_t stride, std::size_t n, T* out);
  void (*wide_run)(const std::byte* first, std::ptrdiff_t stride, std::size_t n, Wide<T>* out);
  /// Reads the values that `indices` name, of which 0 lies at `first`.
  void (*gather)(const std::byte* first, std::ptrdiff_t stride, const std::uint32_t* indices,
                 std::size_t n, T* out);
  void (*wide_gather)(const std::byte* first, std::ptrdiff_t stride, const std::uint32_t* indices,
                      std::size_t n, Wide<T>* out);
};

/// The reader of values of `channels` numbers of type C. A Vec4 of 3 channels has 1 as its fourth.
template <class T, class C>
[[nodiscard]] RASTRUM_API const Reader<T>& reader(int channels) noexcept;

/// The functions that read integers of one type as 64 bits, which are an int64 if `is_signed`.
struct IndexReader {
  bool is_signed;
  std::size_t bytes;  ///< in each integer
  std::uint64_t (*at)(const std::byte* value);
  /// Reads n indices from `first` on, as IndexView::operator[] gives them.
  void (*run)(const std::byte* first, std::ptrdiff_t stride, std::size_t n, std::uint32_t* out);
};
template <class C>
[[nodiscard]] RASTRUM_API const IndexReader& index_reader() noexcept;

/// The integer of fixed width like C, so that `long` and `long long` are one type.
template <class C>
using Fixed = std::conditional_t<
    sizeof(C) == 8, std::conditional_t<std::is_signed_v<C>, std::int64_t, std::uint64_t>,
    std::conditional_t<
        sizeof(C) == 4, std::conditional_t<std::is_signed_v<C>, std::int32_t, std::uint32_t>,
        std::conditional_t<sizeof(C) == 2,
                           std::conditional_t<std::is_signed_v<C>, std::int16_t, std::uint16_t>,
                           std::conditional_t<std::is_signed_v<C>, std::int8_t, std::uint8_t>>>>;

/// Vectors, arrays and spans: all that std::span takes. (<ranges> takes twice as long to compile.)
template <class R>
concept Contiguous = requires(R& r) {
  std::span(r);
};
template <class R>
using ElementOf = std::remove_cv_t<typename decltype(std::span(std::declval<R&>()))::element_type>;

/// Whether the memory of an argument `R&&` outlives the expression: it has a name, or R is a view.
template <class R>
concept Lasting =
    std::is_lvalue_reference_v<R> || std::ranges::enable_borrowed_range<std::remove_cvref_t<R>>;

/// Converts to C and to no other type.
template <class C>
struct Only {
  template <std::same_as<C> To>
  operator To() const;
};
template <class E, class C, std::size_t... i>
consteval bool is_aggregate_of(std::index_sequence<i...>) {
  return requires {
    E{(static_cast<void>(i), Only<C>{})...};
  };
}
template <class E, class C, std::size_t... i>
consteval bool is_made_of(std::index_sequence<i...>) {
  return std::is_constructible_v<E, decltype(static_cast<void>(i), std::declval<C>())...>;
}
// Members of type C in the order x, y, z, w; only a standard layout shows where they lie.
template <class E, class C>
concept HasXY = std::is_standard_layout_v<E> && std::same_as<decltype(E::x), C> &&
    std::same_as<decltype(E::y), C> && offsetof(E, y)
== sizeof(C);
template <class E, class C>
concept HasZ = std::same_as<decltype(E::z), C> && offsetof(E, z)
== 2 * sizeof(C);
template <class E, class C>
concept HasW = std::same_as<decltype(E::w), C> && offsetof(E, w)
== 3 * sizeof(C);
template <class E, class C, std::size_t n>
concept HasMembers = HasXY<E, C> &&
    (n == 2 || (n == 3 && HasZ<E, C>) || (n == 4 && HasZ<E, C> && HasW<E, C>));
template <class E, class C>
concept IsIndexed = requires(const E& e, std::size_t i) {
  { e[i] } -> std::same_as<const C&>;
};

/// Whether an E is `n` numbers of type C and nothing else. Its size alone does not say so: 24 bytes
/// may be three doubles or a vector, 12 may be integers. So the type itself must show it: by having
/// n members of type C, or an array of them, and no constructor; by members x, y, z, w; or by a
/// constructor that takes n numbers and an operator[] that refers to one.
template <class E, class C, std::size_t n>
concept NumbersOf = sizeof(E) == n * sizeof(C) && std::is_trivially_destructible_v<E> &&
                    (std::same_as<E, C> || std::same_as<E, C[n]> || HasMembers<E, C, n> ||
                     (std::is_aggregate_v<E> &&
                      is_aggregate_of<E, C>(std::make_index_sequence<n>{})) ||
                     (IsIndexed<E, C> && is_made_of<E, C>(std::make_index_sequence<n>{})));

/// The first of the types C and Others for which E is `n` numbers; void if there is none.
template <class E, std::size_t n, class C, class... Others>
consteval auto number_in() {
  if constexpr (NumbersOf<E, C, n>)
    return std::type_identity<C>{};
  else if constexpr (sizeof...(Others) > 0)
    return number_in<E, n, Others...>();
}
template <class E, std::size_t n>
using FloatIn = typename decltype(number_in<E, n, float, double>())::type;
template <class E, std::size_t n>
using IndexIn = typename decltype(number_in<E, n, char, signed char, unsigned char, short,
                                            unsigned short, int, unsigned, long, unsigned long,
                                            long long, unsigned long long>())::type;

template <class E>
concept FlatNumber = std::same_as<E, float> || std::same_as<E, double>;
template <class E, std::size_t n>
concept FloatsOf = requires {
  typename FloatIn<E, n>;
};
template <class E, std::size_t n>
concept IndicesOf = requires {
  typename IndexIn<E, n>;
};
/// How many indices an E holds: one or, for edges, triangles and quads, two to four; else 0.
template <class E>
inline constexpr std::size_t kIndicesIn = IndicesOf<E, 1>   ? 1
                                          : IndicesOf<E, 2> ? 2
                                          : IndicesOf<E, 3> ? 3
                                          : IndicesOf<E, 4> ? 4
                                                            : 0;

template <class R, class T>
concept ValuesOf = Contiguous<R> &&
    (FlatNumber<ElementOf<R>> || FloatsOf<ElementOf<R>, static_cast<std::size_t>(kChannels<T>)>);
/// Objects as large as T in float32 or float64 whose type does not show which numbers they hold.
template <class R, class T>
concept UntoldOf = Contiguous<R> && !ValuesOf<R, T> && std::is_class_v<ElementOf<R>> &&
                   (sizeof(ElementOf<R>) == sizeof(T) || sizeof(ElementOf<R>) == 2 * sizeof(T));
template <class R>
concept Indices = (kIndicesIn<ElementOf<R>> > 0);

[[nodiscard]] inline bool is_aligned(const void* p, std::size_t to) {
  return reinterpret_cast<std::uintptr_t>(p) % to == 0;
}

/// This and the next function throw Error{invalid_argument}.
[[noreturn]] void refuse_null(std::size_t count);
[[noreturn]] void refuse_flat(std::size_t numbers, int a_value);
[[nodiscard]] inline const std::byte* values_at(const void* p, std::size_t count) {
  if (p == nullptr && count != 0) refuse_null(count);
  return static_cast<const std::byte*>(p);
}

/// The memory from the first byte of the lowest value to the end of the highest; each value has at
/// least `bytes`.
[[nodiscard]] inline std::span<const std::byte> reach(const std::byte* data, std::size_t size,
                                                      std::ptrdiff_t stride, std::size_t bytes) {
  if (size == 0) return {};
  const std::ptrdiff_t last = static_cast<std::ptrdiff_t>(size - 1) * stride;
  return {data + (last < 0 ? last : 0), static_cast<std::size_t>(last < 0 ? -last : last) + bytes};
}

}  // namespace array_detail

/// A view of `size()` values of type T. The stride is the bytes from one value to the next. It may
/// be larger than a value (a vertex of an interleaved buffer), smaller or negative (views are only
/// read), or 0, which gives one value for all. Numbers need no alignment. A null pointer with a
/// count above 0 throws Error{invalid_argument}.
template <ViewedValue T>
class ArrayView {
 public:
  using Wide = array_detail::Wide<T>;

  ArrayView() = default;
  /// Views a vector, array or span that outlives the expression. Its elements are T, or of a type
  /// that shows that it is as many floats or doubles (Vec3d, float[3], std::array, other libraries'
  /// vectors; docs/arrays.md), or the numbers themselves, value after value. Throws
  /// Error{invalid_argument} if such numbers make no whole values.
  template <array_detail::ValuesOf<T> R>
  requires array_detail::Lasting<R> ArrayView(R&& values)
      : ArrayView(packed_in(std::span(values))) {}
  template <array_detail::ValuesOf<T> R>
  ArrayView(R&&) = delete;  // this array ends before its view does: give it a name first
  template <array_detail::UntoldOf<T> R>
  ArrayView(R&&) = delete;  // its type does not show its numbers: ArrayView::of(numbers, n, stride)

  /// Views `count` values, each of as many numbers as T has; packed without `stride_bytes`.
  template <ValueNumber C>
  [[nodiscard]] static ArrayView of(const C* numbers, std::size_t count,
                                    std::ptrdiff_t stride_bytes = array_detail::kChannels<T> *
                                                                  sizeof(C)) {
    return ArrayView(numbers, array_detail::kChannels<T>, count, stride_bytes);
  }
  /// Views colours of three numbers; their alpha is 1.
  template <ValueNumber C>
  requires std::same_as<T, Vec4>
  [[nodiscard]] static ArrayView rgb(const C* numbers, std::size_t count,
                                     std::ptrdiff_t stride_bytes = 3 * sizeof(C)) {
    return ArrayView(numbers, 3, count, stride_bytes);
  }
  /// Views values in a buffer. Throws Error{invalid_argument} if one of them reaches beyond it, the
  /// type is none of ValueNumber's, or the channels are not T's (a Vec4 may have 3).
  [[nodiscard]] static ArrayView in(std::span<const std::byte> buffer, const ArrayLayout& layout);

  [[nodiscard]] RASTRUM_HD std::size_t size() const { return size_; }
  [[nodiscard]] RASTRUM_HD bool empty() const { return size_ == 0; }

  /// Whether the values are float32, one after the other: devices read no others.
  [[nodiscard]] RASTRUM_HD bool is_packed() const { return reader_ == nullptr; }
  /// Requires is_packed().
  [[nodiscard]] RASTRUM_HD std::span<const T> packed() const { return {data(), size_}; }
  /// Requires is_packed().
  [[nodiscard]] RASTRUM_HD const T* data() const {
    return static_cast<const T*>(static_cast<const void*>(data_));
  }

  /// Value i < size(), rounded to float32.
  [[nodiscard]] RASTRUM_HD T operator[](std::size_t i) const {
#if !defined(__CUDA_ARCH__)
    if (reader_ != nullptr) return reader_->at(place(i));
#endif
    return data()[i];
  }
  /// Value i; positions (Vec3) in float64, without rounding.
  [[nodiscard]] RASTRUM_HD Wide wide(std::size_t i) const {
#if !defined(__CUDA_ARCH__)
    if (reader_ != nullptr) return reader_->wide_at(place(i));
#endif
    return data()[i];
  }
  [[nodiscard]] RASTRUM_HD bool is_wide() const {
    return reader_ != nullptr && is_float64();
  }

  /// The memory that it views, from the lowest value to the highest.
  [[nodiscard]] std::span<const std::byte> reach() const {
    return array_detail::reach(data_, size_, stride_, is_packed() ? sizeof(T) : 1);
  }
  /// The address of value i, to prefetch it.
  [[nodiscard]] const void* address(std::size_t i) const {
    return place(i);
  }

  /// Copies values [first, first + n) to `out`. Requires !is_packed(), as do the three below.
  void read(std::size_t first, std::size_t n, T* out) const {
    reader_->run(place(first), stride_, n, out);
  }
  void read_wide(std::size_t first, std::size_t n, Wide* out) const {
    reader_->wide_run(place(first), stride_, n, out);
  }
  /// Copies the values at `indices`, which must be < size().
  void gather(std::span<const std::uint32_t> indices, T* out) const {
    reader_->gather(data_, stride_, indices.data(), indices.size(), out);
  }
  void gather_wide(std::span<const std::uint32_t> indices, Wide* out) const {
    reader_->wide_gather(data_, stride_, indices.data(), indices.size(), out);
  }

  /// Whether both view the same memory in the same way.
  bool operator==(const ArrayView&) const = default;

 private:
  template <class C>
  ArrayView(const C* numbers, int channels, std::size_t count, std::ptrdiff_t stride_bytes)
      : data_(array_detail::values_at(numbers, count)), size_(count), stride_(stride_bytes) {
    const bool packed = std::same_as<C, float> && channels == array_detail::kChannels<T> &&
                        stride_bytes == static_cast<std::ptrdiff_t>(sizeof(T)) &&
                        array_detail::is_aligned(numbers, alignof(T));
    if (!packed) reader_ = &array_detail::reader<T, C>(channels);
  }
  template <class E, std::size_t extent>
  [[nodiscard]] static ArrayView packed_in(std::span<E, extent> values) {
    using Element = std::remove_cv_t<E>;
    constexpr std::size_t kNumbers = array_detail::kChannels<T>;
    if constexpr (array_detail::FloatsOf<Element, kNumbers>) {
      using C = array_detail::FloatIn<Element, kNumbers>;
      return of(reinterpret_cast<const C*>(values.data()), values.size());
    } else {
      if (values.size() % kNumbers != 0) array_detail::refuse_flat(values.size(), kNumbers);
      return of(values.data(), values.size() / kNumbers);
    }
  }
  [[nodiscard]] const std::byte* place(std::size_t i) const {
    return data_ + static_cast<std::ptrdiff_t>(i) * stride_;
  }
  [[nodiscard]] RASTRUM_HD bool is_float64() const {
    return reader_->wide;
  }

  const std::byte* data_ = nullptr;
  std::size_t size_ = 0;
  std::ptrdiff_t stride_ = sizeof(T);
  const array_detail::Reader<T>* reader_ = nullptr;  ///< null: packed
};

/// Stands for an index that is negative or does not fit into 32 bits: it is out of every range.
inline constexpr std::uint32_t kNoIndex = std::numeric_limits<std::uint32_t>::max();

/// A view of `size()` indices or offsets of any integer type; strides and null are as in ArrayView.
class IndexView {
 public:
  IndexView() = default;
  /// Views a vector, array or span of integers, or of pairs, triples and quadruples of them
  /// (int[3], std::array, other libraries' vectors), whose indices follow each other.
  template <array_detail::Indices R>
  requires array_detail::Lasting<R> IndexView(R&& values)
      : IndexView(packed_in(std::span(values))) {}
  template <array_detail::Indices R>
  IndexView(R&&) = delete;  // this array ends before its view does: give it a name first

  /// Views `count` integers. Without `stride_bytes` they are packed.
  template <IndexNumber C>
  [[nodiscard]] static IndexView of(const C* indices, std::size_t count,
                                    std::ptrdiff_t stride_bytes = sizeof(C)) {
    using Fixed = array_detail::Fixed<C>;
    IndexView v;
    v.data_ = array_detail::values_at(indices, count);
    v.size_ = count;
    v.stride_ = stride_bytes;
    const bool packed = std::same_as<Fixed, std::uint32_t> && stride_bytes == sizeof(C) &&
                        array_detail::is_aligned(indices, alignof(C));
    if (!packed) v.reader_ = &array_detail::index_reader<Fixed>();
    return v;
  }
  /// Views indices in a buffer. Throws Error{invalid_argument} if one of them reaches beyond it, or
  /// if the layout does not have one integer for each index.
  [[nodiscard]] static IndexView in(std::span<const std::byte> buffer, const ArrayLayout& layout);

  [[nodiscard]] RASTRUM_HD std::size_t size() const { return size_; }
  [[nodiscard]] RASTRUM_HD bool empty() const { return size_ == 0; }
  /// Whether the indices are uint32, one after the other: devices read no others.
  [[nodiscard]] RASTRUM_HD bool is_packed() const { return reader_ == nullptr; }
  /// Requires is_packed().
  [[nodiscard]] RASTRUM_HD std::span<const std::uint32_t> packed() const { return {data(), size_}; }
  [[nodiscard]] RASTRUM_HD const std::uint32_t* data() const {
    return static_cast<const std::uint32_t*>(static_cast<const void*>(data_));
  }

  /// Index i < size(); kNoIndex if it is negative or at least 2³² − 1.
  [[nodiscard]] RASTRUM_HD std::uint32_t operator[](std::size_t i) const {
#if !defined(__CUDA_ARCH__)
    if (reader_ != nullptr) {
      const std::uint64_t wide = reader_->at(place(i));
      return wide < kNoIndex ? static_cast<std::uint32_t>(wide) : kNoIndex;
    }
#endif
    return data()[i];
  }
  /// Index i in 64 bits, for offsets. Negative ones become 2⁶³ and more.
  [[nodiscard]] std::uint64_t wide(std::size_t i) const {
    return reader_ == nullptr ? data()[i] : reader_->at(place(i));
  }
  /// Index i in decimal digits, without conversion, for messages.
  [[nodiscard]] std::string text(std::size_t i) const;
  /// Copies indices [first, first + n) to `out`, as operator[] gives them.
  void read(std::size_t first, std::size_t n, std::uint32_t* out) const {
    if (reader_ != nullptr)
      reader_->run(place(first), stride_, n, out);
    else if (n != 0)
      std::memcpy(out, data() + first, n * sizeof(std::uint32_t));
  }
  /// Where the lowest 32 bits of index 0 lie (an index in range has no others), and how many bytes
  /// further those of the next index lie. `first` is null if the integers have fewer bits.
  struct Words {
    const std::byte* first;
    std::ptrdiff_t stride;
  };
  [[nodiscard]] Words words() const {
    static_assert(std::endian::native == std::endian::little);
    const bool wide_enough = reader_ == nullptr || reader_->bytes >= sizeof(std::uint32_t);
    return {wide_enough ? data_ : nullptr, stride_};
  }
  /// The memory that it views, from the lowest value to the highest.
  [[nodiscard]] std::span<const std::byte> reach() const {
    return array_detail::reach(data_, size_, stride_, is_packed() ? sizeof(std::uint32_t) : 1);
  }
  /// A view of indices [first, first + n).
  [[nodiscard]] IndexView subview(std::size_t first, std::size_t n) const {
    IndexView part = *this;
    part.data_ = place(first);
    part.size_ = n;
    return part;
  }

  /// Whether both view the same memory in the same way.
  bool operator==(const IndexView&) const = default;

 private:
  template <class E, std::size_t extent>
  [[nodiscard]] static IndexView packed_in(std::span<E, extent> values) {
    using Element = std::remove_cv_t<E>;
    constexpr std::size_t kNumbers = array_detail::kIndicesIn<Element>;
    using C = array_detail::IndexIn<Element, kNumbers>;
    return of(reinterpret_cast<const C*>(values.data()), kNumbers * values.size());
  }
  [[nodiscard]] const std::byte* place(std::size_t i) const {
    return data_ + static_cast<std::ptrdiff_t>(i) * stride_;
  }

  const std::byte* data_ = nullptr;
  std::size_t size_ = 0;
  std::ptrdiff_t stride_ = sizeof(std::uint32_t);
  const array_detail::IndexReader* reader_ = nullptr;  ///< null: packed
};

}  // namespace rastrum
