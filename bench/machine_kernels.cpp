// SPDX-License-Identifier: BSD-3-Clause
// Bandwidth and arithmetic loops, one source for every instruction set (Highway's dynamic
// dispatch).
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bench/machine_kernels.cpp"
#include <hwy/foreach_target.h>  // first: it includes this file once per target

#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include "machine_kernels.hpp"

HWY_BEFORE_NAMESPACE();
namespace rastrum::bench {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::ScalableTag<float>;

float ReadFloats(const float* data, std::size_t n) {
  const D d;
  const std::size_t lanes = hn::Lanes(d);
  auto a = hn::Zero(d), b = a, c = a, e = a;
  for (std::size_t i = 0; i < n; i += 4 * lanes) {
    a = hn::Add(a, hn::Load(d, data + i));
    b = hn::Add(b, hn::Load(d, data + i + lanes));
    c = hn::Add(c, hn::Load(d, data + i + 2 * lanes));
    e = hn::Add(e, hn::Load(d, data + i + 3 * lanes));
  }
  return hn::GetLane(hn::SumOfLanes(d, hn::Add(hn::Add(a, b), hn::Add(c, e))));
}

void WriteFloats(float* data, std::size_t n, float value) {
  const D d;
  const auto v = hn::Set(d, value);
  for (std::size_t i = 0; i < n; i += hn::Lanes(d)) hn::Store(v, d, data + i);
}

void StreamFloats(float* data, std::size_t n, float value) {
  const D d;
  const auto v = hn::Set(d, value);
  for (std::size_t i = 0; i < n; i += hn::Lanes(d)) hn::Stream(v, d, data + i);
  hwy::FlushStream();
}

void CopyFloats(const float* from, float* to, std::size_t n) {
  const D d;
  for (std::size_t i = 0; i < n; i += hn::Lanes(d)) hn::Stream(hn::Load(d, from + i), d, to + i);
  hwy::FlushStream();
}

// The chains are named variables, because an array of vectors would stay in memory. Twelve of them
// fit the 16 registers of AVX2 and cover 4 cycles of latency on 2 units.
template <class Step>
HWY_INLINE float Chains(std::size_t steps, float factor, Step step) {
  const D d;
  auto a = hn::Set(d, factor), b = a, c = a, e = a, f = a, g = a;
  auto h = a, i = a, j = a, k = a, l = a, m = a;
  for (std::size_t s = 0; s < steps; ++s) {
    a = step(a), b = step(b), c = step(c), e = step(e), f = step(f), g = step(g);
    h = step(h), i = step(i), j = step(j), k = step(k), l = step(l), m = step(m);
  }
  const auto left = hn::Add(hn::Add(hn::Add(a, b), hn::Add(c, e)), hn::Add(f, g));
  const auto right = hn::Add(hn::Add(hn::Add(h, i), hn::Add(j, k)), hn::Add(l, m));
  return hn::GetLane(hn::SumOfLanes(d, hn::Add(left, right)));
}

float FusedMultiplyAdds(std::size_t steps, float factor) {
  const D d;
  const auto v = hn::Set(d, factor);
  return Chains(steps, factor, [&](auto x) { return hn::MulAdd(x, v, v); });
}

float MultipliesAndAdds(std::size_t steps, float factor) {
  const D d;
  const auto v = hn::Set(d, factor);
  return Chains(steps, factor, [&](auto x) { return hn::Add(hn::Mul(x, v), v); });
}

std::size_t LaneCount() {
  return hn::Lanes(D());
}

}  // namespace HWY_NAMESPACE
}  // namespace rastrum::bench
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace rastrum::bench {

HWY_EXPORT(ReadFloats);
HWY_EXPORT(WriteFloats);
HWY_EXPORT(StreamFloats);
HWY_EXPORT(CopyFloats);
HWY_EXPORT(FusedMultiplyAdds);
HWY_EXPORT(MultipliesAndAdds);
HWY_EXPORT(LaneCount);

float read_floats(const float* data, std::size_t n) {
  return HWY_DYNAMIC_DISPATCH(ReadFloats)(data, n);
}
void write_floats(float* data, std::size_t n, float value) {
  HWY_DYNAMIC_DISPATCH(WriteFloats)(data, n, value);
}
void stream_floats(float* data, std::size_t n, float value) {
  HWY_DYNAMIC_DISPATCH(StreamFloats)(data, n, value);
}
void copy_floats(const float* from, float* to, std::size_t n) {
  HWY_DYNAMIC_DISPATCH(CopyFloats)(from, to, n);
}
float fused_multiply_adds(std::size_t steps, float factor) {
  return HWY_DYNAMIC_DISPATCH(FusedMultiplyAdds)(steps, factor);
}
float multiplies_and_adds(std::size_t steps, float factor) {
  return HWY_DYNAMIC_DISPATCH(MultipliesAndAdds)(steps, factor);
}
double arithmetic_operations(std::size_t steps) {
  constexpr double kChains = 12, kOperations = 2;
  return kChains * kOperations * static_cast<double>(steps) *
         static_cast<double>(HWY_DYNAMIC_DISPATCH(LaneCount)());
}

}  // namespace rastrum::bench
#endif
