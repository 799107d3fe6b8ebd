// SPDX-License-Identifier: BSD-3-Clause
// Words, bars and axes over finished pictures. Our own fills and an embedded font draw them, so
// that the bits are the same everywhere (docs/overlay.md, decision 0050).
//
// Lengths are in pixels; (0, 0) is the picture's top left corner, and y goes down. Colours are
// display values with straight alpha. Everything outside a picture is cut off. A call uses one
// thread; a picture is written by one call at a time.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <rastrum/camera.hpp>
#include <rastrum/color_map.hpp>
#include <rastrum/function.hpp>
#include <rastrum/image.hpp>
#include <rastrum/vec.hpp>

namespace RASTRUM_API rastrum {
namespace overlay {

/// The colours of a frame to draw onto: Targets::color8 and Targets::color. Either may be empty;
/// otherwise both have one size.
struct Canvas {
  ImageView<Rgba8> color8{};  ///< straight alpha
  ImageView<Vec4> color{};    ///< premultiplied float32

  [[nodiscard]] int width() const { return color8.empty() ? color.width : color8.width; }
  [[nodiscard]] int height() const { return color8.empty() ? color.height : color8.height; }
};

// Fills.

struct Point {
  std::int32_t x = 0, y = 0;  ///< in 1/256 px
  friend bool operator==(const Point&, const Point&) = default;
};

/// Closed polygons. A place is inside if they wind around it (the nonzero rule). Points are rounded
/// to 1/256 px; one that is not finite or beyond 2²⁰ px throws Error{invalid_argument}.
class Path {
 public:
  void move_to(double x_px, double y_px);
  void line_to(double x_px, double y_px);
  /// A rectangle between two corners, in whichever order.
  void add_rectangle(double x0_px, double y0_px, double x1_px, double y1_px);
  /// A straight stroke with flat ends.
  void add_line(double x0_px, double y0_px, double x1_px, double y1_px, double width_px);
  /// A disc, as a regular polygon that is nowhere farther than 1/16 px from its circle.
  void add_disc(double x_px, double y_px, double radius_px);
  /// move_to and line_to in 1/256 px.
  void move_to(Point point);
  void line_to(Point point);
  [[nodiscard]] bool empty() const { return points_.empty(); }
  [[nodiscard]] const std::vector<Point>& points() const { return points_; }
  /// Where in points() each polygon begins.
  [[nodiscard]] const std::vector<std::size_t>& begins() const { return begins_; }

 private:
  std::vector<Point> points_;
  std::vector<std::size_t> begins_;
};

/// Whether a fill may touch a pixel: false where something in the picture is nearer and hides it.
using PixelTest = FunctionRef<bool(int x, int y)>;

/// Blends `color` into each pixel by the share of its area that `path` covers, in 255ths: exact
/// across the pixel, and in 64 lines down it. Cost: O(64 · height · edges on a line + pixels).
/// Throws Error{invalid_argument} for a canvas whose views differ in size or have rows that
/// overlap.
void fill(const Canvas& canvas, const Path& path, Rgba8 color, PixelTest test = {});
/// Writes the coverage by itself, 0 to 255; 0 where `path` covers nothing.
void fill(ImageView<std::uint8_t> coverage, const Path& path);

// Words.

enum class AlignX : std::uint8_t { left, center, right };
enum class AlignY : std::uint8_t {
  top,       ///< top of the first line's capital letters
  middle,    ///< halfway between `top` and `bottom`
  baseline,  ///< the first line's baseline
  bottom     ///< the last line's baseline
};

struct TextStyle {
  double size_px = 16;  ///< of the em, in (0, 8192]; capital letters are 0.73 of it high
  Rgba8 color{255, 255, 255, 255};
  double halo_px = 0;             ///< how far `halo` reaches around letters, [0, 256]
  Rgba8 halo{0, 0, 0, 255};       ///< makes words legible on any ground
  AlignX align_x = AlignX::left;  ///< the part of the words at the given place
  AlignY align_y = AlignY::baseline;
  int quarter_turns = 0;  ///< counter-clockwise about that place
};

/// Draws text in UTF-8, with \n between lines, at (x, y). The font is DejaVu Sans: ASCII, Latin-1,
/// Latin Extended-A, Greek and the usual signs of measures and mathematics. A character that it
/// does not have, and a byte that is no UTF-8, becomes the font's box; missing_glyphs() lists them.
/// Throws Error{invalid_argument} for a style out of range.
void draw_text(const Canvas& canvas, double x_px, double y_px, std::string_view text,
               const TextStyle& style = {}, PixelTest test = {});
/// The outlines of what draw_text draws, without the halo, for fills of one's own. Throws likewise.
[[nodiscard]] Path text_path(double x_px, double y_px, std::string_view text,
                             const TextStyle& style = {});

struct TextExtent {
  double width_px = 0;   ///< of the widest line
  double height_px = 0;  ///< from the first line's capital letters down to the last line's baseline
};
/// Throws Error{invalid_argument} for a size out of range.
[[nodiscard]] TextExtent measure_text(std::string_view text, double size_px);

/// The code points of `text` that are drawn as boxes, each once, in order; U+FFFD for other than
/// UTF-8.
[[nodiscard]] std::vector<char32_t> missing_glyphs(std::string_view text);

// Numbers.

/// A mark of an axis, and the number beside it.
struct Tick {
  double value = 0;
  std::string label;  ///< UTF-8, with a minus sign
};
/// About `wanted` ticks of an axis from `low` to `high`: multiples of 1, 2 or 5 · 10ⁿ within the
/// range or, if `logarithmic`, powers of ten, thinned or with 2 and 5 between them. The labels of
/// an axis are all decimals or, where all numbers are large or small, all m × 10ⁿ, with the digits
/// that tell them apart. Throws Error{invalid_argument} for a range that is not finite, upside down
/// or, if `logarithmic`, not above 0.
[[nodiscard]] std::vector<Tick> ticks(double low, double high, int wanted,
                                      bool logarithmic = false);

// Bars, axes and titles for pictures of data.

enum class Corner : std::uint8_t { bottom_left, bottom_right, top_left, top_right };
enum class Side : std::uint8_t { right, left, bottom, top };

/// The look of words and lines, one choice for a whole picture.
struct Look {
  Rgba8 color{245, 245, 245, 255};
  Rgba8 halo{20, 22, 26, 200};
  double scale = 1;  ///< times the size that follows the picture's smaller side, in (0, 100]
};
/// A look that is legible on `background`: dark letters on a light one that is mostly opaque.
[[nodiscard]] Look look_on(Vec4 background);
/// The size of small letters in a picture: 1/40 of its smaller side, at least 9 px, times
/// Look::scale, at most 4096 px. Throws Error{invalid_argument} for a scale out of range.
[[nodiscard]] double letter_px(const Canvas& canvas, const Look& look);

struct ScalarBar {
  /// Colours from low to high: display values, straight alpha. If `discrete`, one is drawn beside
  /// the other; else they are blended linearly from the first at `low` to the last at `high`.
  std::vector<Vec4> colors;
  bool discrete = false;
  double low = 0, high = 1;
  bool logarithmic = false;
  std::string title{}, unit{};
  /// The colours of swatches at the ends, and of one for what is no number.
  std::optional<Vec4> below{}, above{}, nan{};
  /// Names in place of numbers, one for each colour.
  std::vector<std::string> categories{};
  Side side = Side::right;
};
/// The bar of `colors`, which are made of `mapping`; without title, unit and swatch for `nan`.
[[nodiscard]] ScalarBar scalar_bar(const ScalarMapping& mapping, const ScalarColors& colors);
/// Throws Error{invalid_argument} for a bar without colours, for a range that is not finite, upside
/// down or, if logarithmic, not above 0, and for categories that are not as many as colours.
void draw_scalar_bar(const Canvas& canvas, const ScalarBar& bar, const Look& look = {});

/// The names of the world's axes, by default x, y and z.
using AxisNames = std::array<std::string_view, 3>;
inline constexpr AxisNames kAxisNames{"x", "y", "z"};

/// Draws arrows along x, y and z in a corner, red, green and blue; those that point away lie
/// behind.
void draw_axes(const Canvas& canvas, const Camera& camera, Corner corner = Corner::bottom_left,
               const Look& look = {}, const AxisNames& names = kAxisNames);

/// Draws the box from `low` to `high` in the world: its edges with ticks, and numbers along one
/// silhouette edge of each axis. Edges that meet only faces towards the viewer are left out. Edges
/// are hidden where `depth` (reversed, the picture's own; may be empty) is nearer. Throws
/// Error{invalid_argument} for a box that is not finite or upside down.
void draw_bounds(const Canvas& canvas, const Camera& camera, Vec3d low, Vec3d high,
                 ImageView<const float> depth = {}, const Look& look = {},
                 const AxisNames& names = kAxisNames);

/// How many times as much as `fitted`, a camera that is fitted to a scene, a camera has to see
/// (`zoomed`), so that its picture has room for this box and the numbers around it: 1.5, or what
/// the farthest corner needs, up to 3.
[[nodiscard]] double room_for_bounds(const Camera& fitted, Vec3d low, Vec3d high, int width,
                                     int height);

/// Draws words at the top of the picture, in the middle.
void draw_title(const Canvas& canvas, std::string_view text, const Look& look = {});
/// Draws smaller words in a corner.
void draw_caption(const Canvas& canvas, std::string_view text, Corner corner,
                  const Look& look = {});

}  // namespace overlay
}  // namespace rastrum
