// SPDX-License-Identifier: BSD-3-Clause
// The colour of a number in a colour map (color_map.hpp). Computed in float64 in the order written
// here and rounded to float32 once (formula: docs/scalar_rules.md).
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <rastrum/color_map.hpp>
#include <rastrum/core/elementary.hpp>
#include <rastrum/core/float_scope.hpp>
#include <rastrum/core/number_text.hpp>
#include <rastrum/error.hpp>

namespace rastrum {
namespace {

constexpr int kMostSteps = 65536;  ///< more than eyes, and 8 bits, tell apart

[[noreturn]] void refuse(const std::string& what) {
  throw Error(Errc::invalid_argument, "ScalarMapping::" + what);
}

bool in_unit(float v) {
  return v >= 0 && v <= 1;
}

void check_color(Vec4 c, const std::string& field) {
  if (!(in_unit(c.x) && in_unit(c.y) && in_unit(c.z) && in_unit(c.w)))
    refuse(field + ": a colour is not in [0, 1]");
}

float blend(float a, float b, double part) {
  return static_cast<float>(static_cast<double>(a) +
                            (static_cast<double>(b) - static_cast<double>(a)) * part);
}

Vec4 blend(const Vec4& a, const Vec4& b, double part) {
  return {blend(a.x, b.x, part), blend(a.y, b.y, part), blend(a.z, b.z, part),
          blend(a.w, b.w, part)};
}

/// The blended colour at t in [0, 1].
Vec4 blended(const std::vector<Vec4>& colors, double t) {
  const double at = t * static_cast<double>(colors.size() - 1);
  const std::size_t i = static_cast<std::size_t>(at), j = std::min(i + 1, colors.size() - 1);
  return blend(colors[i], colors[j], at - static_cast<double>(i));
}

/// `count` colours of a map. Discrete maps repeat their own. Blended ones give colours from end to
/// end, or the middle for a single one.
std::vector<Vec4> chosen(const ColorMap& map, std::size_t count) {
  std::vector<Vec4> colors;
  for (std::size_t i = 0; i < count; ++i)
    colors.push_back(map.discrete ? map.colors[i % map.colors.size()]
                     : count == 1 ? blended(map.colors, 0.5)
                                  : blended(map.colors, static_cast<double>(i) /
                                                            static_cast<double>(count - 1)));
  return colors;
}

ScalarRange checked_range(const ScalarMapping& m, ScalarRange in_use) {
  ScalarRange r = m.range.value_or(in_use);
  const std::string said = number_text(r.low) + " to " + number_text(r.high);
  if (!std::isfinite(r.low) || !std::isfinite(r.high)) refuse("range: not finite: " + said);
  if (r.low > r.high) refuse("range: upside down: " + said);
  if (m.logarithmic && m.symmetric) refuse("logarithmic: a range around 0 has no logarithm");
  if (m.logarithmic && !(r.low > 0)) refuse("range: must lie above 0 with a logarithm: " + said);
  if (m.symmetric) {
    const double far = std::max(std::abs(r.low), std::abs(r.high));
    r = {-far, far};
  }
  if (!std::isfinite(r.high - r.low)) refuse("range: too wide for float64: " + said);
  return r;
}

}  // namespace

ScalarColors::ScalarColors(const ScalarMapping& m, ScalarRange in_use)
    : logarithmic_(m.logarithmic && m.categories.empty()),
      nan_(m.nan),
      opacity_(m.opacity),
      isolines_(m.isolines),
      isoline_color_(m.isoline_color),
      isoline_px_(double{m.isoline_px}) {
  const FloatScope floats;
  if (m.map.colors.empty()) refuse("map: '" + m.map.name + "' has no colours");
  for (const Vec4& c : m.map.colors) check_color(c, "map");
  check_color(m.nan, "nan");
  if (m.below) check_color(*m.below, "below");
  if (m.above) check_color(*m.above, "above");
  check_color(m.isoline_color, "isoline_color");
  if (!(m.isoline_px > 0 && m.isoline_px <= 64)) refuse("isoline_px: must lie in (0, 64]");
  for (std::size_t i = 0; i < isolines_.size(); ++i)
    if (!std::isfinite(isolines_[i])) refuse("isolines[" + std::to_string(i) + "]: not finite");
  std::sort(isolines_.begin(), isolines_.end());
  if (m.steps < 0 || m.steps > kMostSteps)
    refuse("steps: must lie in 0 to " + std::to_string(kMostSteps) + ", got " +
           std::to_string(m.steps));
  for (std::size_t i = 0; i < m.opacity.size(); ++i) {
    if (!std::isfinite(m.opacity[i].value) || !in_unit(m.opacity[i].opacity))
      refuse("opacity[" + std::to_string(i) + "]: not a finite number and an opacity in [0, 1]");
    if (i > 0 && !(m.opacity[i - 1].value < m.opacity[i].value))
      refuse("opacity[" + std::to_string(i) + "]: numbers must rise");
  }

  if (!m.categories.empty()) {
    discrete_ = true;
    colors_ = chosen(m.map, m.categories.size());
    for (std::size_t i = 0; i < m.categories.size(); ++i) {
      if (!std::isfinite(m.categories[i]))
        refuse("categories[" + std::to_string(i) + "]: not finite");
      categories_.emplace_back(m.categories[i], i);
    }
    std::sort(categories_.begin(), categories_.end());
    for (std::size_t i = 1; i < categories_.size(); ++i)
      if (categories_[i - 1].first == categories_[i].first)
        refuse("categories[" + std::to_string(categories_[i].second) + "]: is there already");
    range_ = {categories_.front().first, categories_.back().first};
  } else {
    range_ = checked_range(m, in_use);
    discrete_ = m.steps > 0 || m.map.discrete;
    colors_ = m.steps > 0 ? chosen(m.map, static_cast<std::size_t>(m.steps)) : m.map.colors;
  }
  if (logarithmic_) {
    log_low_ = elementary::log2(range_.low);
    log_span_ = elementary::log2(range_.high) - log_low_;
  }
  below_ = m.below.value_or(colors_.front());
  above_ = m.above.value_or(colors_.back());
  const auto translucent = [](Vec4 c) { return c.w < 1; };
  translucent_ = std::any_of(colors_.begin(), colors_.end(), translucent) || translucent(below_) ||
                 translucent(above_) || translucent(nan_) ||
                 (!isolines_.empty() && translucent(isoline_color_)) ||
                 std::any_of(opacity_.begin(), opacity_.end(),
                             [](const ScalarOpacity& o) { return o.opacity < 1; });
}

double ScalarColors::part(double value) const {
  const double from = logarithmic_ ? elementary::log2(value) - log_low_ : value - range_.low,
               span = logarithmic_ ? log_span_ : range_.high - range_.low;
  if (!(span > 0)) return 0.5;
  return std::clamp(from / span, 0.0, 1.0);
}

Vec4 ScalarColors::map_color(double value) const {
  if (!categories_.empty()) {
    const auto at =
        std::lower_bound(categories_.begin(), categories_.end(), std::pair{value, std::size_t{0}});
    return at != categories_.end() && at->first == value ? colors_[at->second] : nan_;
  }
  if (value < range_.low) return below_;
  if (value > range_.high) return above_;
  if (!discrete_) return blended(colors_, part(value));
  const std::size_t last = colors_.size() - 1;
  return colors_[std::min(
      last, static_cast<std::size_t>(part(value) * static_cast<double>(colors_.size())))];
}

float ScalarColors::opacity_at(double value) const {
  const auto above = std::upper_bound(opacity_.begin(), opacity_.end(), value,
                                      [](double v, const ScalarOpacity& o) { return v < o.value; });
  if (above == opacity_.begin()) return opacity_.front().opacity;
  const ScalarOpacity& a = above[-1];
  if (above == opacity_.end()) return a.opacity;
  // Halves, so that the difference of the widest numbers does not overflow.
  return blend(a.opacity, above->opacity,
               (value / 2 - a.value / 2) / (above->value / 2 - a.value / 2));
}

Vec4 ScalarColors::operator()(double value) const {
  const FloatScope floats;
  if (std::isnan(value) || (logarithmic_ && value < 0)) return nan_;
  Vec4 c = map_color(value);
  if (!opacity_.empty()) c.w *= opacity_at(value);
  return c;
}

Vec4 ScalarColors::with_isolines(Vec4 c, double value, double per_px) const {
  if (!(per_px > 0) || !std::isfinite(value)) return c;
  // The nearest isoline is beside the number.
  const auto above = std::lower_bound(isolines_.begin(), isolines_.end(), value);
  double off = std::numeric_limits<double>::infinity();
  if (above != isolines_.end()) off = *above - value;
  if (above != isolines_.begin()) off = std::min(off, value - above[-1]);
  const double share = std::clamp(isoline_px_ / 2 + 0.5 - off / per_px, 0.0, 1.0);
  return blend(c, isoline_color_, share);
}

}  // namespace rastrum
