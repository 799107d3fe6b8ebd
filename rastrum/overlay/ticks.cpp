// SPDX-License-Identifier: BSD-3-Clause
// Ticks at round numbers and their labels, in integers, so that 0.3 is never 0.30000000000000004.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <string>

#include <rastrum/core/elementary.hpp>
#include <rastrum/core/float_scope.hpp>
#include <rastrum/core/number_text.hpp>
#include <rastrum/core/reject.hpp>
#include <rastrum/overlay.hpp>

namespace rastrum::overlay {
namespace {

/// 10ⁿ, correctly rounded.
double power_of_ten(int n) {
  std::string text = "1e";
  text += std::to_string(n);
  double value = 0;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

/// For x > 0.
int floor_log10(double x) {
  int n = static_cast<int>(std::floor(elementary::log10(x)));
  while (n > -307 && power_of_ten(n) > x) --n;
  while (n < 308 && power_of_ten(n + 1) <= x) ++n;
  return n;
}

std::string superscript(int n) {
  static constexpr const char* kDigits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text = n < 0 ? "⁻" : "";
  for (const char digit : std::to_string(std::abs(n))) text += kDigits[digit - '0'];
  return text;
}

/// number · 10^−decimals, with all decimals.
std::string decimal(std::int64_t number, int decimals) {
  std::string digits = std::to_string(std::abs(number));
  const auto places = static_cast<std::size_t>(std::max(decimals, 0));
  if (digits.size() <= places) digits.insert(0, places + 1 - digits.size(), '0');
  if (places != 0) digits.insert(digits.size() - places, 1, '.');
  return number < 0 ? "−" + digits : digits;
}

/// number · 10^exponent, written alike on an axis. `most`: floor(log10) of the largest magnitude.
std::string label_of(std::int64_t number, int exponent, int most) {
  if (number == 0) return "0";
  if (most < 5 && most > -4) {
    for (; exponent > 0; --exponent) number *= 10;
    return decimal(number, -exponent);
  }
  const std::string mantissa = decimal(number, most - exponent);
  return mantissa + "×10" + superscript(most);
}

/// Ticks at the ends alone, for a range so narrow at its distance from 0 that rounding loses steps.
std::vector<Tick> ends(double low, double high) {
  std::vector<Tick> found;
  for (const double value : {low, high}) {
    std::string label = number_text(value);
    if (label.front() == '-') label.replace(0, 1, "−");
    found.push_back({value, label});
    if (low == high) break;
  }
  return found;
}

std::vector<Tick> linear_ticks(double low, double high, int wanted) {
  const double span = high - low, most = std::max(std::fabs(low), std::fabs(high));
  if (!(span > most * 1e-12) || !std::isfinite(span)) return ends(low, high);
  const double least_step = span / wanted;
  int exponent = floor_log10(least_step);
  if (exponent < -290) return ends(low, high);
  int factor = 10;
  for (const int f : {5, 2, 1})
    if (f * power_of_ten(exponent) >= least_step * (1 - 1e-9)) factor = f;
  if (factor == 10) {
    factor = 1;
    ++exponent;
  }
  const double step = factor * power_of_ten(exponent);
  const auto first = static_cast<std::int64_t>(std::ceil(low / step - 1e-6)),
             last = static_cast<std::int64_t>(std::floor(high / step + 1e-6));
  std::vector<Tick> found;
  // Steps are at most 2.5 times as long as asked for, so with three wanted one lies within.
  if (first > last) return wanted < 3 ? linear_ticks(low, high, wanted + 1) : ends(low, high);
  const double largest =
      std::max(std::fabs(static_cast<double>(first)), std::fabs(static_cast<double>(last))) * step;
  const int magnitude = largest > 0 ? floor_log10(largest * (1 + 1e-9)) : 0;
  for (std::int64_t i = first; i <= last; ++i) {
    const std::int64_t number = i * factor;
    const auto whole = static_cast<double>(number);
    found.push_back(
        {exponent < 0 ? whole / power_of_ten(-exponent) : whole * power_of_ten(exponent),
         label_of(number, exponent, magnitude)});
  }
  return found;
}

std::vector<Tick> logarithmic_ticks(double low, double high, int wanted) {
  const int first = floor_log10(low * (1 + 1e-9)), last = floor_log10(high * (1 + 1e-9));
  const int decades = last - first;
  const bool plain = first >= -3 && last <= 4;
  const int apart = std::max(1, (decades + wanted - 1) / wanted);
  const bool between = 3 * decades <= wanted;
  std::vector<Tick> found;
  for (int n = first; n <= last; ++n) {
    if (((n % apart) + apart) % apart != 0) continue;
    for (const int m : {1, 2, 5}) {
      if (m != 1 && !between) break;
      const double value = n < 0 ? m / power_of_ten(-n) : m * power_of_ten(n);
      if (value < low * (1 - 1e-9) || value > high * (1 + 1e-9)) continue;
      std::string label;
      if (plain)
        label = label_of(m, n, 0);
      else
        label = (m == 1 ? "" : std::to_string(m) + "×") + "10" + superscript(n);
      found.push_back({value, label});
    }
  }
  return found.size() >= 2 ? found : linear_ticks(low, high, wanted);
}

}  // namespace

std::vector<Tick> ticks(double low, double high, int wanted, bool logarithmic) {
  const FloatScope floats;
  if (!(std::isfinite(low) && std::isfinite(high) && low <= high))
    reject("ticks: the range ", low, " to ", high, " is not finite or upside down");
  if (logarithmic && !(low > 0)) reject("ticks: a logarithmic range must lie above 0, got ", low);
  wanted = std::max(wanted, 1);
  return logarithmic ? logarithmic_ticks(low, high, wanted) : linear_ticks(low, high, wanted);
}

}  // namespace rastrum::overlay
