// What the pipeline draws: vertices from any source, points, lines or triangles over them, and the
// two hooks of the programmable stages (fragment test and shading), which see blocks, so that one
// virtual call serves up to 64 fragments.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include <rastrum/config.hpp>
#include <rastrum/program.hpp>
#include <rastrum/tuning.hpp>
#include <rastrum/core/image.hpp>
#include <rastrum/raster/assemble/clip.hpp>
#include <rastrum/raster/draws/projection.hpp>
#include <rastrum/raster/draws/samples.hpp>
#include <rastrum/raster/frame/options.hpp>
#include <rastrum/raster/setup/piece.hpp>
#include <rastrum/raster/shade/color.hpp>

namespace rastrum::raster {

/// The vertex stage of a draw.
class VertexSource {
 public:
  virtual ~VertexSource() = default;
  /// Projects vertices [begin, end) into out[0 … end − begin).
  virtual void project(std::size_t begin, std::size_t end, Viewport viewport, Isa isa,
                       ProjectedVertex* out) const noexcept = 0;
  /// Projects the vertices that `indices` name, into out[0 … size).
  virtual void project_indexed(std::span<const std::uint32_t> indices, Viewport viewport, Isa isa,
                               ProjectedVertex* out) const noexcept {
    for (std::size_t i = 0; i < indices.size(); ++i)
      project(indices[i], std::size_t{indices[i]} + 1, viewport, isa, out + i);
  }
  /// Homogeneous position for the clipper; NaN where the vertex is not finite.
  [[nodiscard]] virtual Vec4d clip_position(std::size_t vertex) const noexcept = 0;
};

class BlockShader;
class FragmentTest;

/// Primitives over one vertex source. Their flags are those of its pieces.
struct Draw : Primitives {
  const VertexSource* source = nullptr;  ///< must be set
  /// Flags by material, so that a mesh of several needs no draw for each: triangle t has those of
  /// material_flags[face_materials[t]] too. Both or none.
  std::span<const std::uint32_t> face_materials{}, material_flags{};
  /// What shades it and, where `flags` has kTested, tests its fragments; null: what
  /// RendererAccess::draw is given. A built-in shader (shade/lit.hpp, shade/material.hpp) takes its
  /// draws for the instances of its scene, in order, whatever stands between them.
  const BlockShader* shader = nullptr;
  const FragmentTest* test = nullptr;

  // Filled by the pipeline.
  std::uint64_t first_id = 0;
  std::size_t first_vertex = 0;  ///< of this draw in FrameGeometry::projected
  std::size_t number = 0;        ///< among the draws of its shader

  [[nodiscard]] RASTRUM_HD std::uint32_t vertex(std::uint64_t primitive, int corner) const {
    const std::size_t i = static_cast<std::size_t>(primitive) * static_cast<std::size_t>(topology) +
                          static_cast<std::size_t>(corner);
    return indices.empty() ? static_cast<std::uint32_t>(i) : indices[i];
  }
  [[nodiscard]] RASTRUM_HD std::uint32_t flags_of(std::uint64_t primitive) const {
    return material_flags.empty()
               ? flags
               : flags | material_flags[face_materials[static_cast<std::size_t>(primitive)]];
  }
  /// Those that some primitive may have.
  [[nodiscard]] std::uint32_t any_flags() const {
    std::uint32_t any = flags;
    for (const std::uint32_t f : material_flags) any |= f;
    return any;
  }
  /// What the winding makes of `cull`, for counter-clockwise fronts.
  [[nodiscard]] RASTRUM_HD Cull effective_cull() const {
    if (cull == Cull::none || winding == Winding::either) return Cull::none;
    const bool swap = winding == Winding::clockwise;
    return (cull == Cull::back) != swap ? Cull::back : Cull::front;
  }
  /// Whether the setup kernel may make its pieces; otherwise assemble_primitive does.
  [[nodiscard]] bool has_kernel() const {
    return topology == Topology::triangles && depth_bias == 0 && depth_bias_slope == 0;
  }
};

/// The draw that holds primitive `id`. O(log draws).
[[nodiscard]] RASTRUM_HD inline const Draw& draw_with(std::span<const Draw> draws,
                                                      std::uint64_t id) {
  std::size_t low = 0;
  std::size_t high = draws.size();
  while (high - low > 1) {
    const std::size_t middle = (low + high) / 2;
    (draws[middle].first_id <= id ? low : high) = middle;
  }
  return draws[low];
}

/// The projected scene, for setup and again for shading.
struct FrameGeometry {
  int width = 0, height = 0;
  Viewport viewport;
  std::span<const Draw> draws;
  const ProjectedVertex* projected = nullptr;  ///< null: vertices are projected where they are read
  Isa isa = Isa::scalar;

  [[nodiscard]] ProjectedVertex vertex(const Draw& draw, std::uint32_t index) const {
    if (projected != nullptr) return projected[draw.first_vertex + index];
    ProjectedVertex v;
    draw.source->project(index, std::size_t{index} + 1, viewport, isa, &v);
    return v;
  }

  /// As VertexSource's.
  [[nodiscard]] Vec4d clip_position(const Draw& draw, std::uint32_t index) const {
    return draw.source->clip_position(index);
  }

  /// The draw that holds primitive `id`. O(log draws).
  [[nodiscard]] const Draw& draw_of(std::uint64_t id) const { return draw_with(draws, id); }
};

/// Decides which covered samples of a block survive, before the maximum. Thread-safe.
class FragmentTest {
 public:
  virtual ~FragmentTest() = default;
  /// The subset of `block.mask` that is kept. `points`: where in their pixels the fragments are;
  /// null: at the centres.
  [[nodiscard]] virtual std::uint64_t test(const FrameGeometry& frame, const Piece& piece,
                                           const Block& block,
                                           const ShadingPoints* points) const noexcept = 0;
};

/// The visible surface of an 8 × 8 block: a key per sample.
struct VisibleBlock {
  const std::uint64_t* keys = nullptr;    ///< 64, element 8 · row + column
  std::uint64_t covered = 0;              ///< samples that hold a surface and lie in the image
  int x0 = 0, y0 = 0;                     ///< first pixel
  void* scratch = nullptr;                ///< the shader's, zeroed when a thread begins a frame
  BlockColors* extra = nullptr;           ///< its further outputs; null: not wanted
  const ShadingPoints* points = nullptr;  ///< where they are; null: at their pixels' centres
};

/// Shades the visible surface of a block. Thread-safe.
class BlockShader {
 public:
  virtual ~BlockShader() = default;
  /// Sets the colours of the covered samples (others may be set to anything). Returns whether all
  /// of them are opaque; alpha need not be set then.
  virtual bool shade(const FrameGeometry& frame, const VisibleBlock& block, Isa isa,
                     BlockColors& colors) const noexcept = 0;
  /// Asks the cache for what shading primitive `id` will read: a hint for who knows long before.
  virtual void prefetch(const FrameGeometry& /*frame*/, std::uint64_t /*id*/) const noexcept {}
  /// The alpha of all fragments, where it is one and known before they are shaded.
  [[nodiscard]] virtual std::optional<float> alpha() const noexcept { return std::nullopt; }
  /// How many bytes of VisibleBlock::scratch the shader uses, for each thread; 64-byte aligned,
  /// kept from block to block of a frame.
  [[nodiscard]] virtual std::size_t scratch_bytes() const noexcept { return 0; }
  /// How many VisibleBlock::extra it sets (Targets::extra), at most kMaxExtraTargets.
  [[nodiscard]] virtual std::size_t extra_count() const noexcept { return 0; }
};

/// A thread's VisibleBlock::scratch.
class ShaderScratch {
 public:
  /// As many bytes as `shader` (null: none) asks for, zeroed.
  void begin(const BlockShader* shader) {
    lines_.assign(
        shader == nullptr ? 0 : (shader->scratch_bytes() + sizeof(Line) - 1) / sizeof(Line), {});
  }
  [[nodiscard]] void* data() { return lines_.data(); }

 private:
  struct alignas(64) Line {
    std::byte bytes[64];
  };
  std::vector<Line> lines_;
};

/// One frame, as the façade hands it to a rasterizer.
struct FrameRequest {
  int width = 0, height = 0;
  Isa isa = Isa::scalar;
  std::span<Draw> draws;
  std::string_view draw_noun = "draw";  ///< what messages call one: a scene's are instances
  const FragmentTest* test = nullptr;   ///< null: no piece is tested
  const BlockShader* shader = nullptr;  ///< may be null where no colour is asked for
  Vec4 background{};                    ///< display values, straight alpha
  Targets targets;
  Tuning tuning;
  bool in_place = false;            ///< arrays and targets are memory of the device that draws
  std::uint64_t texture_bytes = 0;  ///< that a memory limit counts beside the frame's own
  bool hierarchical_z = true;
  TransparencyOptions transparency;  ///< for a visibility that keeps layers
  int samples = 1;                   ///< a pixel; more want a visibility that keeps layers
  /// The shader returns linear light: it is blended as such, also over the background, and the sRGB
  /// transfer is applied to the result.
  bool linear_light = false;
};

}  // namespace rastrum::raster
