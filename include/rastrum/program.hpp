// SPDX-License-Identifier: BSD-3-Clause
// The programmable pipeline: the caller's own vertex function, fragment function and, if wanted,
// discard function, with a varying struct of the caller's own.
//
//   struct Varying { Vec3 color; };  // with V + V and V * float
//   Program program(
//       [&](std::uint32_t i) { return VertexOutput<Varying>{clip(i), {color(i)}}; },
//       [&](const Varying& v, const Fragment&) { return Vec4{v.color.x, …, 1}; });
//   ProgramDraw draw = program.draw(vertex_count, indices);
//   renderer.draw({&draw, 1}, frame, {.color8 = image});
//
// A frame may have draws of several programs.
//
// Shading is deferred: the vertex function runs once a vertex for positions, and again for the
// corners of each triangle that is seen in a block, so that no varying is stored. All functions are
// called from several threads at once. The first exception stops the frame, which throws it.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <tuple>
#include <type_traits>
#include <utility>

#include <rastrum/held.hpp>
#include <rastrum/primitives.hpp>
#include <rastrum/vec.hpp>

namespace RASTRUM_API rastrum {

namespace raster {
struct RASTRUM_INSIDE ProgramHooks;
}

/// The weight of each corner's values in a fragment; a line has two corners, a point one.
struct Weights {
  double b[3];      ///< they add up to 1
  double db_dx[3];  ///< change of each per px
  double db_dy[3];
};

/// The fragment that a fragment function gets.
struct Fragment {
  int x = 0, y = 0;
  Vec2 from_centre{0, 0};      ///< where it is shaded, px from the pixel's centre
  float depth = 0;             ///< reversed
  std::uint64_t id = 0;        ///< number of its primitive in order of submission
  std::uint64_t triangle = 0;  ///< number of its triangle, line or point within the draw
  std::size_t draw = 0;        ///< index among the frame's draws
  bool front = true;  ///< is seen from its front (Primitives::winding; `either`: counter-clockwise)
  std::uint32_t vertex[3] = {};  ///< indices, as many as the topology has
  Weights weights;
  Vec2 point;  ///< for points: place in the square, (0, 0) at the top left to (1, 1)
};

/// A type that can be interpolated: Σ varyingᵢ · weightᵢ, in its own arithmetic.
template <class V>
concept Varying = std::copyable<V> && requires(const V& v, float weight) {
  { v + v } -> std::convertible_to<V>;
  { v* weight } -> std::convertible_to<V>;
};

/// The result of a vertex function. `V` must be a Varying, which Program checks.
template <class V>
struct VertexOutput {
  Vec4 clip{};  ///< reversed depth as by world_to_clip: z = w at the near plane, 0 at the far one
  V varying;
};

/// The discard function of programs that discard nothing.
struct KeepAll {};

class ProgramStages;

/// Primitives whose vertices and colours a program makes; it must outlive the frame. The first
/// exception of its functions stops the frame, and the call that draws it throws that.
struct ProgramDraw : Primitives {
  const ProgramStages* program = nullptr;  ///< must be set
};

/// Fragments of one primitive in an 8 × 8 block.
struct FragmentBatch {
  Topology topology = Topology::triangles;
  std::span<const Fragment> fragments;  ///< 1 to 64, all with the same `vertex`
};

/// A program as the library calls it: once for each block of fragments that the library has found.
class ProgramStages {
 public:
  ProgramStages(const ProgramStages&) = delete;  // draws point to it
  ProgramStages& operator=(const ProgramStages&) = delete;

 protected:
  ProgramStages(std::size_t extra_count, bool discards);
  virtual ~ProgramStages();

 private:
  friend struct raster::ProgramHooks;

  // An exception of these functions stops the frame, which throws it.
  /// Writes the clip positions of vertices [first, first + count).
  virtual void positions(std::uint32_t first, std::size_t count, Vec4* clip) const = 0;
  /// Writes the outputs of each fragment: its colour into `colors`, the others into `extra`, one
  /// array for each; `extra` is null if none is wanted.
  virtual void shade(const FragmentBatch& batch, Vec4* colors, Vec4 (*extra)[64]) const = 0;
  /// A bit for each fragment, the lowest for the first: 1 if it is discarded.
  [[nodiscard]] virtual std::uint64_t discarded(const FragmentBatch& batch) const = 0;

  Owner<raster::ProgramHooks> hooks_;
};

/// A program of three functions. Vertex: VertexOutput<V>(std::uint32_t index). Shade: Vec4(const
/// V&, const Fragment&), the premultiplied display value, or a std::array or tuple of Vec4, of
/// which those after the first go to Targets::extra. Discard: bool(const V&, const Fragment&), true
/// for a fragment to discard.
template <class Vertex, class Shade, class Discard = KeepAll>
class Program final : public ProgramStages {
 public:
  using VaryingType = decltype(std::declval<const Vertex&>()(std::uint32_t{}).varying);
  static_assert(Varying<VaryingType>,
                "a varying V is interpolated: give it `V operator+(const V&) const` and "
                "`V operator*(float) const`");

  Program(Vertex vertex, Shade shade, Discard discard = {})
      : ProgramStages(kExtra, kDiscards),
        vertex_(std::move(vertex)),
        shade_(std::move(shade)),
        discard_(std::move(discard)) {}

  /// `indices`: 3 per triangle, 2 per line or 1 per point; they must outlive the frame. Empty:
  /// vertices in order.
  [[nodiscard]] ProgramDraw draw(std::size_t vertex_count,
                                 std::span<const std::uint32_t> indices = {},
                                 Topology topology = Topology::triangles) const& {
    ProgramDraw d;
    d.program = this;
    d.vertex_count = vertex_count;
    d.indices = indices;
    d.topology = topology;
    d.primitive_count =
        (indices.empty() ? vertex_count : indices.size()) / static_cast<std::size_t>(topology);
    if constexpr (kDiscards) d.flags = kTested;
    return d;
  }
  ProgramDraw draw(std::size_t, std::span<const std::uint32_t> = {},
                   Topology = Topology::triangles) const&& = delete;  // the draw points to it

 private:
  using Output = decltype(std::declval<const Shade&>()(std::declval<const VaryingType&>(),
                                                       std::declval<const Fragment&>()));
  static constexpr bool kDiscards = !std::is_same_v<Discard, KeepAll>;
  static constexpr std::size_t kExtra = [] {
    if constexpr (std::is_convertible_v<Output, Vec4>)
      return std::size_t{0};
    else
      return std::tuple_size_v<Output> - 1;
  }();
  static_assert(kExtra <= kMaxExtraTargets, "a shader has at most 8 outputs");

  void positions(std::uint32_t first, std::size_t count, Vec4* clip) const override {
    for (std::size_t i = 0; i < count; ++i)
      clip[i] = vertex_(static_cast<std::uint32_t>(first + i)).clip;
  }

  void shade(const FragmentBatch& batch, Vec4* colors, Vec4 (*extra)[64]) const override {
    for_each(batch, [&](std::size_t i, const VaryingType& v, const Fragment& fragment) {
      const Output output = shade_(v, fragment);
      if constexpr (std::is_convertible_v<Output, Vec4>) {
        colors[i] = output;
      } else {
        colors[i] = std::get<0>(output);
        if (extra != nullptr) [&]<std::size_t... k>(std::index_sequence<k...>) {
            ((extra[k][i] = std::get<k + 1>(output)), ...);
          }
        (std::make_index_sequence<kExtra>{});
      }
    });
  }

  [[nodiscard]] std::uint64_t discarded(const FragmentBatch& batch) const override {
    std::uint64_t holes = 0;
    if constexpr (kDiscards)
      for_each(batch, [&](std::size_t i, const VaryingType& v, const Fragment& fragment) {
        holes |= std::uint64_t{discard_(v, fragment)} << i;
      });
    return holes;
  }

  /// Calls f(number, varying, fragment) for each fragment.
  template <class F>
  void for_each(const FragmentBatch& batch, F&& f) const {
    const auto varying = [&](int corner) {
      return vertex_(batch.fragments[0].vertex[corner]).varying;
    };
    const auto each = [&](auto&& interpolate) {
      for (std::size_t i = 0; i < batch.fragments.size(); ++i) {
        const Fragment& fragment = batch.fragments[i];
        const auto& b = fragment.weights.b;
        const float weight[3] = {static_cast<float>(b[0]), static_cast<float>(b[1]),
                                 static_cast<float>(b[2])};
        f(i, VaryingType(interpolate(weight)), fragment);
      }
    };
    const VaryingType v0 = varying(0);
    if (batch.topology == Topology::points) return each([&](const auto&) { return v0; });
    // The static_assert above reports other types in a sentence; errors about operators would hide
    // it.
    if constexpr (Varying<VaryingType>) {
      const VaryingType v1 = varying(1);
      if (batch.topology == Topology::lines)
        return each([&](const auto& b) { return v0 * b[0] + v1 * b[1]; });
      const VaryingType v2 = varying(2);
      each([&](const auto& b) { return v0 * b[0] + v1 * b[1] + v2 * b[2]; });
    }
  }

  Vertex vertex_;
  Shade shade_;
  Discard discard_;
};

}  // namespace rastrum
