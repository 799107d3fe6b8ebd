// SPDX-License-Identifier: BSD-3-Clause
// Words, bars and axes over finished pictures: our own fills and an embedded font, so that they are
// the same bits everywhere (docs/overlay.md, decision 0050).
//
// Lengths are in pixels, (0, 0) the picture's top left corner and y downwards; colours are display
// values with straight alpha. Everything outside of a picture is cut off. One thread; a picture is
// written by one call at a time.
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

/// The colours of a frame to draw onto, Targets::color8 and Targets::color. Either may be empty;
/// both have one size.
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

/// Closed polygons; inside is every place that they wind around (the nonzero rule). Points are
/// rounded to 1/256 px; one that is not finite or beyond 2²⁰ px throws Error{invalid_argument}.
class Path {
 public:
  void move_to(double x_px, double y_px);
  void line_to(double x_px, double y_px);
  /// A rectangle between two corners, in whichever order.
  void add_rectangle(double x0_px, double y0_px, double x1_px, double y1_px);
  /// A straight stroke with flat ends.
  void add_line(double x0_px, double y0_px, double x1_px, double y1_px, double width_px);
  /// A regular polygon that is nowhere farther than 1/16 px from its circle.
  void add_disc(double x_px, double y_px, double radius_px);
  /// The same in 1/256 px.
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

/// Whether a pixel may be touched: what hides a fill where something of the picture is nearer.
using PixelTest = FunctionRef<bool(int x, int y)>;

/// Blends `color` over what `path` covers of each pixel: the share of its area, exact across and in
/// 64 lines down the pixel, in 255ths. Cost: O(64 · height · edges on a line + pixels).
/// Throws Error{invalid_argument} for a canvas whose views differ in size or have rows that
/// overlap.
void fill(const Canvas& canvas, const Path& path, Rgba8 color, PixelTest test = {});
/// The coverage by itself, 0 to 255.
void fill(ImageView<std::uint8_t> coverage, const Path& path);

// Words.

enum class AlignX : std::uint8_t { left, center, right };
enum class AlignY : std::uint8_t {
  top,       ///< of the capital letters of the first line
  middle,    ///< of capital letters of the first line and the last line's baseline
  baseline,  ///< of the first line
  bottom     ///< the last line's baseline
};

struct TextStyle {
  double size_px = 16;  ///< of the em; capital letters are 0.73 of it. In (0, 8192]
  Rgba8 color{255, 255, 255, 255};
  double halo_px = 0;             ///< how far around the letters `halo` reaches, [0, 256]
  Rgba8 halo{0, 0, 0, 255};       ///< so that words are read on any ground
  AlignX align_x = AlignX::left;  ///< what of the words lies at the given place
  AlignY align_y = AlignY::baseline;
  int quarter_turns = 0;  ///< counter-clockwise about that place
};

/// UTF-8, with \n between lines, at (x, y): DejaVu Sans's ASCII, Latin-1, Latin Extended-A, Greek
/// and the usual signs of measures and mathematics. A character that the font does not have, and a
/// byte that is no UTF-8, becomes the font's box; missing_glyphs() lists them. Throws
/// Error{invalid_argument} for a style out of range.
void draw_text(const Canvas& canvas, double x_px, double y_px, std::string_view text,
               const TextStyle& style = {}, PixelTest test = {});
/// The same as outlines, for fills of one's own; without the halo.
[[nodiscard]] Path text_path(double x_px, double y_px, std::string_view text,
                             const TextStyle& style = {});

struct TextExtent {
  double width_px = 0;   ///< of the longest line
  double height_px = 0;  ///< from the first line's capital letters down to the last line's baseline
};
[[nodiscard]] TextExtent measure_text(std::string_view text, double size_px);

/// The code points of `text` that are drawn as boxes, each once, in order; U+FFFD for what is no
/// UTF-8.
[[nodiscard]] std::vector<char32_t> missing_glyphs(std::string_view text);

// Numbers.

/// Ticks of an axis from `low` to `high`, both finite: multiples of 1, 2 or 5 · 10ⁿ within the
/// range, about `wanted` of them, or, logarithmically (both > 0), powers of ten, thinned or with 2
/// and 5 between them. Labels are written in decimals, or as m × 10ⁿ where all are
/// large or small, as all ticks of an axis are: with the digits that tell them apart.
struct Tick {
  double value = 0;
  std::string label;  ///< UTF-8, with a minus sign
};
[[nodiscard]] std::vector<Tick> ticks(double low, double high, int wanted,
                                      bool logarithmic = false);

// Bars, axes and titles for pictures of data.

enum class Corner : std::uint8_t { bottom_left, bottom_right, top_left, top_right };
enum class Side : std::uint8_t { right, left, bottom, top };

/// The look of words and lines, one choice for a whole picture.
struct Look {
  Rgba8 color{245, 245, 245, 255};
  Rgba8 halo{20, 22, 26, 200};
  double scale = 1;  ///< of letters and lines, whose sizes follow the picture's smaller side
};
/// A look that is read on `background`: dark letters on a light one.
[[nodiscard]] Look look_on(Vec4 background);
/// The size of small letters in a picture: 1/40 of its smaller side, at least 9 px.
[[nodiscard]] double letter_px(const Canvas& canvas, const Look& look);

struct ScalarBar {
  /// From low to high, display values, straight alpha; drawn one beside the other where `discrete`,
  /// else blended linearly from the first at `low` to the last at `high`.
  std::vector<Vec4> colors;
  bool discrete = false;
  double low = 0, high = 1;
  bool logarithmic = false;
  std::string title{}, unit{};
  /// Swatches at the ends, and one for what is no number.
  std::optional<Vec4> below{}, above{}, nan{};
  /// Names in the place of numbers, one for each colour.
  std::vector<std::string> categories{};
  Side side = Side::right;
};
/// The bar of what colours numbers, and of the mapping that `colors` is made of.
[[nodiscard]] ScalarBar scalar_bar(const ScalarMapping& mapping, const ScalarColors& colors);
/// Throws Error{invalid_argument} for a bar without colours, a range that is not finite or upside
/// down or, with a logarithm, not above 0, and categories that are not as many as colours.
void draw_scalar_bar(const Canvas& canvas, const ScalarBar& bar, const Look& look = {});

/// The names of the world's axes, by default x, y and z.
using AxisNames = std::array<std::string_view, 3>;
inline constexpr AxisNames kAxisNames{"x", "y", "z"};

/// The directions of x, y and z in a corner: red, green and blue, those that point away behind.
void draw_axes(const Canvas& canvas, const Camera& camera, Corner corner = Corner::bottom_left,
               const Look& look = {}, const AxisNames& names = kAxisNames);

/// The box from `low` to `high` in the world with ticks: its edges but for those that nothing but
/// faces towards the viewer meet, hidden where `depth` (reversed, the picture's own; may be empty)
/// is nearer, and numbers along one silhouette edge of each axis. Throws Error{invalid_argument}
/// for a box that is not finite or upside down.
void draw_bounds(const Canvas& canvas, const Camera& camera, Vec3d low, Vec3d high,
                 ImageView<const float> depth = {}, const Look& look = {},
                 const AxisNames& names = kAxisNames);

/// How many times as much as a camera that is fitted to a scene one sees that has this box and the
/// numbers around it in its picture (`zoomed`): 1.5, or what the farthest corner needs, up to 3.
[[nodiscard]] double room_for_bounds(const Camera& fitted, Vec3d low, Vec3d high, int width,
                                     int height);

/// Words at the top of the picture, in the middle, above all else.
void draw_title(const Canvas& canvas, std::string_view text, const Look& look = {});
/// Smaller words in a corner.
void draw_caption(const Canvas& canvas, std::string_view text, Corner corner,
                  const Look& look = {});

}  // namespace overlay
}  // namespace rastrum
