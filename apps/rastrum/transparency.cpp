#include "transparency.hpp"

#include <cmath>
#include <string_view>
#include <utility>

#include "arguments.hpp"

namespace rastrum::cli {
namespace {

constexpr std::string_view kFilter = "filter:";
constexpr std::pair<std::string_view, Transparency> kWords[] = {
    {"exact", Transparency::exact},   {"unsorted", Transparency::unsorted},
    {"wboit", Transparency::wboit},   {"mboit4", Transparency::mboit4},
    {"mboit6", Transparency::mboit6}, {"mlab4", Transparency::mlab4},
    {"none", Transparency::none}};

}  // namespace

std::string transparency_list() {
  std::string words;
  for (const auto& [word, method] : kWords) {
    words.append(words.empty() ? "" : ", ").append(word);
    if (method == Transparency::exact) words.append(", filter:K");
  }
  return words;
}

std::vector<std::string> transparency_names() {
  std::vector<std::string> names;
  for (const auto& [word, method] : kWords) {
    names.emplace_back(word);
    if (method == Transparency::exact) names.emplace_back(kFilter.substr(0, kFilter.size() - 1));
  }
  return names;
}

void parse_transparency(const std::string& text, TransparencyOptions& options) {
  for (const auto& [word, method] : kWords)
    if (text == word) {
      options.method = method;
      return;
    }
  if (!text.starts_with(kFilter))
    throw UsageError("--transparency",
                     "expected one of " + transparency_list() + ", got '" + text + "'");
  options.method = Transparency::filter;
  options.filter =
      parse_integer("--transparency", std::string_view(text).substr(kFilter.size()), 1, 64);
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
