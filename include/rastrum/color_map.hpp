// SPDX-License-Identifier: BSD-3-Clause
// Numbers that become colours: colour maps by their usual names, and what of a map a number is
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
  /// At even steps, the first at the low end and the last at the high one, blended linearly
  /// between; where `discrete`, each has an equal part of the range for itself.
  std::vector<Vec4> colors{};
  bool discrete = false;
};

/// The names that color_map knows, without the reversed ones.
[[nodiscard]] std::vector<std::string_view> color_map_names();

/// A map by its usual name: viridis, plasma, inferno, magma, cividis, turbo, gray, hot, bone, jet,
/// ColorBrewer's Blues, RdBu, Spectral and more, coolwarm, twilight, hsv, and of colours that mean
/// categories tab10, tab20, Set1, Set2, Dark2, Paired (`discrete`). NAME_r is it from high to low.
/// Colours are the published ones in 8 bits. Throws Error{not_found}, which says the nearest
/// name and lists them all.
[[nodiscard]] ColorMap color_map(std::string_view name);

/// The same, or a list of the caller's own: #RRGGBB or #RRGGBBAA, separated by commas or spaces.
/// Throws Error{invalid_argument} for a list with something else in it.
[[nodiscard]] ColorMap color_map_or_list(std::string_view text);

/// The numbers from `low` to `high`.
struct ScalarRange {
  double low = 0, high = 1;
  bool operator==(const ScalarRange&) const = default;
};

/// The opacity at a number, in [0, 1].
struct ScalarOpacity {
  double value = 0;
  float opacity = 1;
};

/// How numbers become colours.
struct ScalarMapping {
  ColorMap map = color_map("viridis");
  std::optional<ScalarRange>
      range{};               ///< none: from the least to the greatest finite number in use
  bool logarithmic = false;  ///< even steps of the map are even factors; range above 0
  bool symmetric = false;    ///< the range is widened, so that 0 lies in its middle
  int steps = 0;  ///< so many colours of equal parts of the range, up to 65536; 0: blended
  /// Number i has colour i of the map (the same colours again where there are too few of a discrete
  /// one; of a blended one as far apart as can be), all others are `nan`. No range is asked for.
  /// Between vertices of different categories lie numbers that are none: give them one a face.
  std::vector<double> categories{};
  std::optional<Vec4> below{}, above{};  ///< beyond the range; none: the colours of its ends
  Vec4 nan{0.5F, 0.5F, 0.5F, 1};
  /// Opacities at rising numbers, linear between and the outermost ones beyond; they multiply the
  /// colours' own alpha, but that of `nan`.
  std::vector<ScalarOpacity> opacity{};
  /// Lines on meshes where these numbers are, as wide in pixels at any distance.
  std::vector<double> isolines{};
  Vec4 isoline_color{0, 0, 0, 1};
  float isoline_px = 1;  ///< in (0, 64]
};

/// A mapping with a range, as pictures use it. Immutable (a move is a copy); the same bits on every
/// machine.
class ScalarColors {
 public:
  ScalarColors(const ScalarColors&) = default;
  ScalarColors& operator=(const ScalarColors&) = default;
  /// `in_use`: the range where the mapping has none, so that of finite_range(). Throws
  /// Error{invalid_argument}, which names the field, for a map without colours, colours and
  /// opacities that are not in [0, 1], a range upside down, not finite, so wide that high − low is
  /// not, or with a logarithm not above 0; a logarithm beside `symmetric`; steps below 0 or
  /// beyond 65536;
  /// categories that are not finite or twice there; values of opacity that do not rise.
  ScalarColors(const ScalarMapping& mapping, ScalarRange in_use);

  /// The colour of a number: a display value, straight alpha.
  [[nodiscard]] Vec4 operator()(double value) const;
  /// Where between the ends of the range a number of it lies, [0, 1].
  [[nodiscard]] double part(double value) const;
  /// With what `symmetric` made of it.
  [[nodiscard]] ScalarRange range() const { return range_; }
  /// Whether a colour may have alpha below 1.
  [[nodiscard]] bool is_translucent() const { return translucent_; }
  /// As of a ScalarBar: one a step or category, or those of the map.
  [[nodiscard]] const std::vector<Vec4>& colors() const { return colors_; }
  [[nodiscard]] bool is_discrete() const { return discrete_; }
  /// Whether colours are blended evenly over the range, at one opacity; isolines may lie over them.
  [[nodiscard]] bool is_ramp() const {
    return !logarithmic_ && !discrete_ && categories_.empty() && opacity_.empty();
  }
  [[nodiscard]] Vec4 below() const { return below_; }  ///< of numbers below the range
  [[nodiscard]] Vec4 above() const { return above_; }
  [[nodiscard]] Vec4 nan() const { return nan_; }

  [[nodiscard]] bool has_isolines() const { return !isolines_.empty(); }
  /// `color` with the isolines over it, where the number is `value` and changes by `per_px` from
  /// pixel to pixel along its steepest way.
  [[nodiscard]] Vec4 with_isolines(Vec4 color, double value, double per_px) const;

 private:
  [[nodiscard]] Vec4 map_color(double value) const;
  [[nodiscard]] float opacity_at(double value) const;

  ScalarRange range_;
  bool logarithmic_;
  bool discrete_ = false;
  bool translucent_ = false;
  double log_low_ = 0, log_span_ = 0;  ///< of base 2
  std::vector<Vec4> colors_;
  std::vector<std::pair<double, std::size_t>> categories_;  ///< by number; place in colors_
  Vec4 below_, above_, nan_;
  std::vector<ScalarOpacity> opacity_;
  std::vector<double> isolines_;  ///< rising
  Vec4 isoline_color_;
  double isoline_px_ = 1;
};

/// From the least to the greatest finite number; none: {0, 0}. `above_zero`: of those above 0.
[[nodiscard]] ScalarRange finite_range(std::span<const double> values, bool above_zero = false);

}  // namespace rastrum
