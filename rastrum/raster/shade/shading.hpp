// The shading and the fragment test of a draw or a frame: values, which the host calls a block at a
// time and a device reads. A caller's own function (hooks.hpp) is one alternative of each.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <variant>

#include <rastrum/image.hpp>
#include <rastrum/parallel/device.hpp>
#include <rastrum/raster/draws/samples.hpp>
#include <rastrum/raster/setup/piece.hpp>
#include <rastrum/vec.hpp>

namespace rastrum::raster {

class BlockShader;
class FragmentTest;
struct BinSurface;
struct BlockColors;
struct BlockPixels;
struct FrameGeometry;
struct SeenBin;
struct LitScene;
struct MaterialScene;
struct VisibleBlock;

enum class LitModel : std::uint8_t { flat, normal, id, lambert, phong, wireframe };

/// The plain shaders (lit.hpp).
struct LitShading {
  LitModel model = LitModel::flat;
  const LitScene* scene = nullptr;
  bool operator==(const LitShading&) const = default;
};

/// The scene's materials (material.hpp).
struct MaterialShading {
  const MaterialScene* scene = nullptr;
  bool linear = false;  ///< leaves the transfer function to FrameRequest::linear_light
  bool operator==(const MaterialShading&) const = default;
};

/// FragmentRuns number pixels by 64 · row + column.
inline constexpr int kRunPitch = 64;
/// This many keys and pixels beyond them may be read, whatever they are, and as many colours set.
inline constexpr std::size_t kRunSlack = 16;

/// Fragments of a region of at most 64 × 64 px, of which those of a primitive lie side by side,
/// whatever their pixels.
struct FragmentRuns {
  const std::uint64_t* keys;
  const std::uint16_t* pixels;
  std::size_t count;
  const std::uint64_t* firsts;  ///< a bit a fragment: the first of its primitive
  const std::uint64_t* wanted;  ///< a bit a fragment: to be shaded; null: all are
  int x0, y0;                   ///< first pixel of the region
};

/// The source of colours, and the alpha that they are multiplied by (alpha.hpp). All that it points
/// to must outlive the frame. The built-in ones take their draws for the instances of their scene,
/// in order, whatever stands between them.
class Shading {
 public:
  Shading() = default;  ///< none: no colour can be asked for
  Shading(const LitShading& lit) : colors_(lit) {}
  Shading(const MaterialShading& material) : colors_(material) {}
  /// The caller's own.
  Shading(const BlockShader& own) : colors_(&own) {}
  /// The same; null: none.
  Shading(const BlockShader* own) {
    if (own != nullptr) colors_ = own;
  }
  /// The same colours, multiplied by alpha. Fragments without alpha are not shaded, and there are
  /// no further outputs. `blending`: the scene whose translucent materials have the alpha, and
  /// whose textures must hold those of such materials; null: there are none.
  [[nodiscard]] Shading with_alpha(const MaterialScene* blending, float opacity) const {
    Shading s = *this;
    s.blending_ = blending;
    s.opacity_ = opacity;
    return s;
  }

  [[nodiscard]] explicit operator bool() const { return colors_.index() != 0; }
  bool operator==(const Shading&) const = default;

  /// Each is null where the colours are another's.
  [[nodiscard]] const LitShading* lit() const { return std::get_if<LitShading>(&colors_); }
  [[nodiscard]] const MaterialShading* material() const {
    return std::get_if<MaterialShading>(&colors_);
  }
  [[nodiscard]] const BlockShader* own() const {
    const auto* const own = std::get_if<const BlockShader*>(&colors_);
    return own == nullptr ? nullptr : *own;
  }
  [[nodiscard]] const MaterialScene* blending() const { return blending_; }
  [[nodiscard]] float opacity() const { return opacity_; }

  /// As BlockShader's, whatever shades. Requires that this is not empty.
  bool shade(const FrameGeometry& frame, const VisibleBlock& block, Isa isa,
             BlockColors& colors) const noexcept;
  /// The same, and store_opaque of what it gives, at once. Returns false and sets nothing where
  /// that cannot be: then `shade` must be asked.
  bool store(const FrameGeometry& frame, const VisibleBlock& block, Isa isa, Rgba8 empty,
             BlockPixels to) const noexcept;
  /// The same as `shade` of fragments that lie side by side by primitive: colours[i] is that of
  /// fragment i, with the bits that `shade` gives; kRunSlack beyond them may be set. Returns false
  /// and sets nothing where only blocks are shaded: then `shade` must be asked.
  bool shade_runs(const FrameGeometry& frame, const FragmentRuns& runs, Isa isa,
                  Vec4* colors) const noexcept;
  /// Whether the blocks of a bin are shaded sooner with VisibleBlock::bin.
  [[nodiscard]] bool suits_bin(const BinSurface& bin, Isa isa) const noexcept;
  /// Fills `own` for rows of blocks, from `row` to own.end_row. Requires suits_bin.
  void see_bin(const FrameGeometry& frame, const BinSurface& bin, int row, Isa isa,
               SeenBin& own) const noexcept;
  void prefetch(const FrameGeometry& frame, std::uint64_t id) const noexcept;
  [[nodiscard]] std::optional<float> alpha() const noexcept;
  [[nodiscard]] bool wants_depth() const noexcept;           ///< of none: false
  [[nodiscard]] std::size_t scratch_bytes() const noexcept;  ///< of none: 0
  [[nodiscard]] std::size_t extra_count() const noexcept;    ///< of none: 0

  struct Hash {
    std::size_t operator()(const Shading& s) const noexcept;
  };

 private:
  [[nodiscard]] bool has_alpha() const { return blending_ != nullptr || opacity_ != 1; }
  bool shade_colors(const FrameGeometry& frame, const VisibleBlock& block, Isa isa,
                    BlockColors& colors) const noexcept;

  std::variant<std::monostate, LitShading, MaterialShading, const BlockShader*> colors_;
  const MaterialScene* blending_ = nullptr;
  float opacity_ = 1;
};

/// AlphaMode::mask (alpha.hpp): fragments below a material's cutoff are holes. The scene's textures
/// must hold those of the masks.
struct MaskTest {
  const MaterialScene* scene = nullptr;
  bool operator==(const MaskTest&) const = default;
};

/// Decides, before the maximum, which fragments of pieces with kTested are there. All that it
/// points to must outlive the frame.
class Testing {
 public:
  Testing() = default;  ///< all are
  Testing(const MaskTest& masks) : test_(masks) {}
  /// The caller's own; null: all are.
  Testing(const FragmentTest* own) {
    if (own != nullptr) test_ = own;
  }

  [[nodiscard]] explicit operator bool() const { return test_.index() != 0; }
  bool operator==(const Testing&) const = default;

  /// Each is null where another tests.
  [[nodiscard]] const MaskTest* masks() const { return std::get_if<MaskTest>(&test_); }
  [[nodiscard]] const FragmentTest* own() const {
    const auto* const own = std::get_if<const FragmentTest*>(&test_);
    return own == nullptr ? nullptr : *own;
  }

  /// As FragmentTest's.
  [[nodiscard]] std::uint64_t test(const FrameGeometry& frame, const Piece& piece,
                                   const Block& block, const ShadingPoints* points) const noexcept;

 private:
  std::variant<std::monostate, MaskTest, const FragmentTest*> test_;
};

}  // namespace rastrum::raster
