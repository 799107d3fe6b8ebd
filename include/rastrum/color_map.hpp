// SPDX-License-Identifier: BSD-3-Clause
// How numbers become colours: colour maps by their usual names, and the colour of a number in a map
// (docs/scalar_rules.md). Colours are display values with straight alpha.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <rastrum/vec.hpp>

namespace RASTRUM_API rastrum {

/// Colours from low to high.
struct ColorMap {
  std::string name{};
  /// They lie at even steps, from the low end to the high one, and are blended linearly between;
  /// where `discrete`, each has an equal part of the range for itself.
  std::vector<Vec4> colors{};
  bool discrete = false;
};

/// The names that color_map knows, without the reversed ones.
[[nodiscard]] std::vector<std::string_view> color_map_names();

/// The map of that name: viridis, plasma, inferno, magma, cividis, turbo, gray, hot, bone, jet,
/// ColorBrewer's Blues, RdBu, Spectral and more, coolwarm, twilight, hsv; for categories tab10,
/// tab20, Set1, Set2, Dark2, Paired (`discrete`). NAME_r is the same map from high to low. Colours
/// are the published ones in 8 bits. Throws Error{not_found}, which says the nearest name and lists
/// them all.
[[nodiscard]] ColorMap color_map(std::string_view name);

/// The map of that name, or one of listed colours: #RRGGBB or #RRGGBBAA, separated by commas or
/// spaces. Throws as color_map, and Error{invalid_argument} for a list with something else in it.
[[nodiscard]] ColorMap color_map_or_list(std::string_view text);

/// The numbers from `low` to `high`.
struct ScalarRange {
  double low = 0, high = 1;
  bool operator==(const ScalarRange&) const = default;
};

/// A point of a curve: at the number `value` the opacity is `opacity`, in [0, 1].
struct ScalarOpacity {
  double value = 0;
  float opacity = 1;
};

/// How numbers become colours.
struct ScalarMapping {
  ColorMap map = color_map("viridis");
  /// None: from the least to the greatest finite number in use.
  std::optional<ScalarRange> range{};
  bool logarithmic = false;  ///< even steps of the map are even factors; the range is above 0
  bool symmetric = false;    ///< the range is widened, so that 0 lies in its middle
  int steps = 0;  ///< colours, each of an equal part of the range, up to 65536; 0: as the map
  /// If there are any: number i of these has colour i, and all other numbers have `nan`. A discrete
  /// map with too few colours begins again; a blended one gives colours at even steps. The range
  /// does not count. Give categories to faces: between vertices that differ, interpolation yields
  /// numbers that are none.
  std::vector<double> categories{};
  std::optional<Vec4> below{}, above{};  ///< beyond the range; none: as its ends
  Vec4 nan{0.5F, 0.5F, 0.5F, 1};
  /// A curve through points at rising numbers: linear between them, and constant beyond the first
  /// and the last. It multiplies the alpha of all colours but `nan`.
  std::vector<ScalarOpacity> opacity{};
  /// Numbers at which lines are drawn on surfaces, of one width in pixels at any distance.
  std::vector<double> isolines{};
  Vec4 isoline_color{0, 0, 0, 1};
  float isoline_px = 1;  ///< in (0, 64]
};

/// A ScalarMapping whose range is known, as pictures use it. Immutable (a move is a copy). The bits
/// are the same on every machine.
class ScalarColors {
 public:
  ScalarColors(const ScalarColors&) = default;
  ScalarColors& operator=(const ScalarColors&) = default;
  /// `in_use`: the range if the mapping has none, from finite_range(). Throws
  /// Error{invalid_argument} that names the field: for a map without colours; colours and opacities
  /// outside [0, 1]; a range that is upside down, not finite, too wide for float64 or, with a
  /// logarithm, not above 0; a logarithm beside `symmetric`; steps below 0 or beyond 65536;
  /// categories that are not finite or twice there; values of opacity that do not rise; isolines
  /// that are not finite, or of a width out of range.
  ScalarColors(const ScalarMapping& mapping, ScalarRange in_use);

  /// The colour of a number, as display values with straight alpha.
  [[nodiscard]] Vec4 operator()(double value) const;
  /// The place of a number between the ends of the range, in [0, 1]; 0.5 if the ends are equal.
  [[nodiscard]] double part(double value) const;
  /// The range, widened if the mapping is `symmetric`.
  [[nodiscard]] ScalarRange range() const { return range_; }
  /// Whether a colour may have alpha below 1.
  [[nodiscard]] bool is_translucent() const { return translucent_; }
  /// The colours for a bar: one for each step or category, else those of the map.
  [[nodiscard]] const std::vector<Vec4>& colors() const { return colors_; }
  [[nodiscard]] bool is_discrete() const { return discrete_; }
  /// Whether colours are blended evenly over the range, at one opacity; isolines may lie over them.
  [[nodiscard]] bool is_ramp() const {
    return !logarithmic_ && !discrete_ && categories_.empty() && opacity_.empty();
  }
  [[nodiscard]] Vec4 below() const { return below_; }  ///< the colour of numbers below the range
  [[nodiscard]] Vec4 above() const { return above_; }
  [[nodiscard]] Vec4 nan() const { return nan_; }

  [[nodiscard]] bool has_isolines() const { return !isolines_.empty(); }
  /// Blends the isolines over `color`, at a place where the number is `value` and changes by
  /// `per_px` from pixel to pixel in its steepest direction.
  [[nodiscard]] Vec4 with_isolines(Vec4 color, double value, double per_px) const;

 private:
  [[nodiscard]] Vec4 map_color(double value) const;
  [[nodiscard]] float opacity_at(double value) const;

  ScalarRange range_;
  bool logarithmic_;
  bool discrete_ = false;
  bool translucent_ = false;
  double log_low_ = 0, log_span_ = 0;  ///< logarithms of base 2
  std::vector<Vec4> colors_;
  std::vector<std::pair<double, std::size_t>> categories_;  ///< sorted; places in colors_
  Vec4 below_, above_, nan_;
  std::vector<ScalarOpacity> opacity_;
  std::vector<double> isolines_;  ///< rising
  Vec4 isoline_color_;
  double isoline_px_ = 1;
};

/// The range of the finite numbers; without any {0, 0}. `above_zero`: of those above 0 alone.
[[nodiscard]] ScalarRange finite_range(std::span<const double> values, bool above_zero = false);

}  // namespace rastrum
