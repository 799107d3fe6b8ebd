// Colours to 8 bits, in lanes: quantize (color.hpp). Include it in the namespace of an instruction
// set, after Highway.

/// The result is in the lowest 8 bits; above them are the bits of 2²³. A sum of that size has no
/// bits for fractions, so it is rounded to the nearest whole number, ties to even.
template <class V>
HWY_INLINE auto quantize_lanes(V v) {
  const hn::DFromV<V> d;
  const V low = hn::IfThenElseZero(hn::Gt(v, hn::Zero(d)), v);
  const V scaled = hn::Mul(hn::Min(low, hn::Set(d, 1.0F)), hn::Set(d, 255.0F));
  return hn::BitCast(hn::RebindToUnsigned<hn::DFromV<V>>(),
                     hn::Add(scaled, hn::Set(d, 8388608.0F)));
}

/// Pixels with the alpha that `alpha` has in its highest 8 bits; the others are 0.
template <class V>
HWY_INLINE auto packed(V r, V g, V b, std::uint32_t alpha) {
  const hn::RebindToUnsigned<hn::DFromV<V>> d;
  const auto green_blue =
      hn::Or(hn::ShiftLeft<8>(quantize_lanes(g)), hn::ShiftLeft<16>(quantize_lanes(b)));
  // The shifts drop the bits of 2²³ from green and blue; those of red become the alpha.
  constexpr std::uint32_t kSum = 0x4B000000;
  const auto red = hn::Add(quantize_lanes(r), hn::Set(d, alpha - kSum));
  return hn::Or(red, green_blue);
}
