// The programmable pipeline: a vertex function, a fragment function and, if wanted, a discard
// function of the caller's own, over a varying struct of the caller's own.
//
//   struct Varying { Vec3 color; };  // with V + V and V * float
//   raster::Program program(
//       [&](std::uint32_t i) { return raster::VertexOutput<Varying>{clip(i), {color(i)}}; },
//       [&](const Varying& v, const raster::Fragment&) { return Vec4{v.color.x, …, 1}; });
//   raster::Draw draw = program.draw(vertex_count, indices);
//   renderer.draw({&draw, 1}, targets);
//
// A frame may have draws of several programs. A caller's BlockShader that is to shade the draws of
// a program instead (one that wraps it, say) goes into Draw::shading.
//
// Shading is deferred: the vertex function runs once a vertex for positions, and again for the
// corners of each triangle that is seen in a block, so that no varying is stored. All functions are
// called from several threads at once and must not throw.
#pragma once

#include <bit>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <tuple>
#include <type_traits>
#include <utility>

#include <rastrum/raster/draws/geometry.hpp>
#include <rastrum/raster/draws/hooks.hpp>
#include <rastrum/raster/setup/make_piece.hpp>
#include <rastrum/raster/shade/interpolate.hpp>

namespace rastrum::raster {

/// What can be interpolated: Σ varyingᵢ · weightᵢ, in the caller's own arithmetic.
template <class V>
concept Varying = std::copyable<V> && requires(const V& v, float weight) {
  { v + v } -> std::convertible_to<V>;
  { v* weight } -> std::convertible_to<V>;
};

/// `V`: a Varying, which Program sees to.
template <class V>
struct VertexOutput {
  Vec4 clip{};  ///< reversed depth: z = w at the near plane, 0 at the far one (world_to_clip's)
  V varying;
};

/// Discards nothing.
struct KeepAll {};

/// Vertex: VertexOutput<V>(std::uint32_t index). Shade: Vec4(const V&, const Fragment&), the
/// premultiplied display value, or a std::array or tuple of Vec4, of which those after the first go
/// to Targets::extra. Discard: bool(const V&, const Fragment&), true for a hole.
/// A program is the vertex source, the shader and the fragment test of its draws.
template <class Vertex, class Shade, class Discard = KeepAll>
class Program final : public VertexSource, public BlockShader {
 public:
  using VaryingType = decltype(std::declval<const Vertex&>()(std::uint32_t{}).varying);
  static_assert(Varying<VaryingType>,
                "a varying V is interpolated: give it `V operator+(const V&) const` and "
                "`V operator*(float) const`");

  Program(Vertex vertex, Shade shade, Discard discard = {})
      : vertex_(std::move(vertex)), shade_(std::move(shade)), test_(*this, std::move(discard)) {}
  Program(const Program&) = delete;  // draws and the test point to it
  Program& operator=(const Program&) = delete;

  /// `indices`: 3 per triangle, 2 per line or 1 per point, which must outlive the frame; empty:
  /// vertices in order.
  [[nodiscard]] Draw draw(std::size_t vertex_count, std::span<const std::uint32_t> indices = {},
                          Topology topology = Topology::triangles) const {
    Draw d;
    d.source = this;
    d.vertex_count = vertex_count;
    d.indices = indices;
    d.topology = topology;
    d.primitive_count =
        (indices.empty() ? vertex_count : indices.size()) / static_cast<std::size_t>(topology);
    d.shading = this;
    d.test = test();
    if constexpr (kDiscards) d.flags = kTested;
    return d;
  }
  /// Null where the program discards nothing.
  [[nodiscard]] const FragmentTest* test() const {
    if constexpr (kDiscards)
      return &test_;
    else
      return nullptr;
  }

  void project(std::size_t begin, std::size_t end, Viewport viewport, Isa,
               ProjectedVertex* out) const noexcept override {
    for (std::size_t i = begin; i < end; ++i)
      out[i - begin] = raster::project(vertex_(static_cast<std::uint32_t>(i)).clip, viewport);
  }

  [[nodiscard]] Vec4d clip_position(std::size_t vertex) const noexcept override {
    const Vec4 c = vertex_(static_cast<std::uint32_t>(vertex)).clip;
    return {c.x, c.y, c.z, c.w};
  }

  bool shade(const FrameGeometry& frame, const VisibleBlock& block, Isa,
             BlockColors& colors) const noexcept override {
    bool opaque = true;
    for (std::uint64_t left = block.covered; left != 0;) {
      const std::uint64_t low = block.keys[std::countr_zero(left)] & kIdMask;
      std::uint64_t mask = 0;
      for (std::uint64_t m = left; m != 0; m &= m - 1) {
        const int i = std::countr_zero(m);
        mask |= std::uint64_t{(block.keys[i] & kIdMask) == low} << i;
      }
      left &= ~mask;
      for_each_fragment(frame, id_of_key(low), mask, block.x0, block.y0, block.points,
                        [&](int i, const VaryingType& v, Fragment& fragment) {
                          fragment.depth = std::bit_cast<float>(
                              static_cast<std::uint32_t>(block.keys[i] >> kIdBits));
                          opaque &= set(block, i, shade_(v, std::as_const(fragment)), colors);
                        });
    }
    return opaque;
  }

  [[nodiscard]] std::size_t extra_count() const noexcept override { return kExtra; }

 private:
  using Output = decltype(std::declval<const Shade&>()(std::declval<const VaryingType&>(),
                                                       std::declval<const Fragment&>()));
  static constexpr std::size_t kExtra = [] {
    if constexpr (std::is_convertible_v<Output, Vec4>)
      return std::size_t{0};
    else
      return std::tuple_size_v<Output> - 1;
  }();
  static_assert(kExtra <= kMaxExtraTargets, "a shader has at most 8 outputs");

  /// Returns whether the colour is opaque.
  static bool set(const VisibleBlock& block, int i, const Output& output, BlockColors& colors) {
    if constexpr (kExtra == 0 && std::is_convertible_v<Output, Vec4>) {
      return colors.set(i, output);
    } else {
      if (block.extra != nullptr) [&]<std::size_t... k>(std::index_sequence<k...>) {
          (block.extra[k].set(i, std::get<k + 1>(output)), ...);
        }
      (std::make_index_sequence<kExtra>{});
      return colors.set(i, std::get<0>(output));
    }
  }

  static constexpr bool kDiscards = !std::is_same_v<Discard, KeepAll>;

  class Test final : public FragmentTest {
   public:
    Test(const Program& program, Discard discard)
        : program_(program), discard_(std::move(discard)) {}

    std::uint64_t test(const FrameGeometry& frame, const Piece& piece, const Block& block,
                       const ShadingPoints* points) const noexcept override {
      std::uint64_t kept = block.mask;
      if constexpr (kDiscards)
        program_.for_each_fragment(frame, id_of_key(piece.low), block.mask, block.bx * kBlockSize,
                                   block.by * kBlockSize, points,
                                   [&](int i, const VaryingType& v, Fragment& fragment) {
                                     fragment.depth = depth_at(piece, fragment.x, fragment.y);
                                     if (discard_(v, std::as_const(fragment)))
                                       kept &= ~(std::uint64_t{1} << i);
                                   });
      return kept;
    }

   private:
    const Program& program_;
    Discard discard_;
  };

  /// Calls f(bit, varying, fragment) for the fragments of primitive `id` in `mask`.
  template <class F>
  void for_each_fragment(const FrameGeometry& frame, std::uint64_t id, std::uint64_t mask, int x0,
                         int y0, const ShadingPoints* points, F&& f) const {
    FragmentLocator locator(frame);
    const Draw& draw = frame.draw_of(id);
    const auto varying = [&](int corner) {
      return vertex_(draw.vertex(id - draw.first_id, corner)).varying;
    };
    const auto each = [&](auto&& interpolate) {
      for (std::uint64_t m = mask; m != 0; m &= m - 1) {
        const int i = std::countr_zero(m);
        Fragment fragment = locator.locate(id, x0, y0, i, points);
        const auto& b = fragment.weights.b;
        const float weight[3] = {static_cast<float>(b[0]), static_cast<float>(b[1]),
                                 static_cast<float>(b[2])};
        f(i, VaryingType(interpolate(weight)), fragment);
      }
    };
    const VaryingType v0 = varying(0);
    if (draw.topology == Topology::points) return each([&](const auto&) { return v0; });
    // What is no Varying has had its sentence; a page about operators would hide it.
    if constexpr (Varying<VaryingType>) {
      const VaryingType v1 = varying(1);
      if (draw.topology == Topology::lines)
        return each([&](const auto& b) { return v0 * b[0] + v1 * b[1]; });
      const VaryingType v2 = varying(2);
      each([&](const auto& b) { return v0 * b[0] + v1 * b[1] + v2 * b[2]; });
    }
  }

  Vertex vertex_;
  Shade shade_;
  Test test_;
};

}  // namespace rastrum::raster
