#include "transparency.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

#include <rastrum/family.hpp>

#include "arguments.hpp"

namespace rastrum::cli {
namespace {

constexpr std::string_view kFilter = "filter:";

struct Named {
  std::string_view name;
  TransparencyOptions options;
};
const std::vector<Named>& methods() {
  static const std::vector<Named> list{{"exact", {}},
                                       {"filter:3", family::filtered(3)},
                                       {"unsorted", {Transparency::unsorted}},
                                       {"wboit", family::wboit()},
                                       {"mboit4", family::mboit4()},
                                       {"mboit6", family::mboit6()},
                                       {"mlab4", family::mlab4()},
                                       {"none", {Transparency::none}}};
  return list;
}

bool same_method(const TransparencyOptions& a, const TransparencyOptions& b) {
  return a.method == b.method && a.added == b.added;
}

}  // namespace

std::string transparency_list() {
  std::string words;
  for (const Named& m : methods())
    words.append(words.empty() ? "" : ", ")
        .append(m.name.starts_with(kFilter) ? "filter:K" : m.name);
  return words;
}

int filter_of(const TransparencyOptions& options) {
  for (int k = 1; k <= 64; ++k)
    if (same_method(options, family::filtered(k))) return k;
  return 0;
}

std::string transparency_name(const TransparencyOptions& options) {
  if (const int k = filter_of(options); k != 0) return std::string(kFilter) + std::to_string(k);
  for (const Named& m : methods())
    if (same_method(options, m.options)) return std::string(m.name);
  return {};
}

std::vector<std::string> transparency_names(const TransparencyOptions& now) {
  std::vector<std::string> names;
  for (const Named& m : methods())
    names.emplace_back(filter_of(m.options) != 0 && filter_of(now) != 0 ? transparency_name(now)
                                                                        : m.name);
  return names;
}

void parse_transparency(const std::string& text, TransparencyOptions& options) {
  TransparencyOptions found;
  const auto known = std::ranges::find(methods(), text, &Named::name);
  if (known != methods().end())
    found = known->options;
  else if (text.starts_with(kFilter))
    found = family::filtered(
        parse_integer("--transparency", std::string_view(text).substr(kFilter.size()), 1, 64));
  else
    throw UsageError("--transparency",
                     "expected one of " + transparency_list() + ", got '" + text + "'");
  options.method = found.method;
  options.added = found.added;
}

float parse_alpha_threshold(const std::string& text) {
  if (text.empty()) return 1 - 1 / 128.0F;
  const double value = parse_number("--alpha-threshold", text);
  if (!(value > 0 && value <= 1))
    throw UsageError("--alpha-threshold", "must be > 0 and at most 1, got '" + text + "'");
  return static_cast<float>(value);
}

ErrorPicture make_error_picture(ImageView<const Rgba8> color8,
                                ImageView<const std::uint8_t> errors) {
  ErrorPicture picture{Image<Rgba8>(color8.width, color8.height)};
  for (int y = 0; y < color8.height; ++y)
    for (int x = 0; x < color8.width; ++x) {
      const Rgba8 c = color8(x, y);
      // Rec. 709's weights; half of it, so that red stands out.
      const double luma = (0.2126 * c.r + 0.7152 * c.g + 0.0722 * c.b) * c.a / 255;
      const auto grey = static_cast<std::uint8_t>(std::lround(luma / 2));
      const bool wrong = errors(x, y) != 0;
      picture.wrong += wrong;
      picture.image(x, y) = wrong ? Rgba8{255, 0, 0, 255} : Rgba8{grey, grey, grey, 255};
    }
  return picture;
}

}  // namespace rastrum::cli
