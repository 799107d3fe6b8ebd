// SPDX-License-Identifier: BSD-3-Clause
#include "frame_images.hpp"

#include <optional>
#include <type_traits>
#include <utility>

#include <rastrum/raster/context/target_table.hpp>

#include "arguments.hpp"

namespace rastrum::cli {

namespace {

/// Calls f(row) for each image that the program writes by name.
template <class F>
void each_kind(const F& f) {
  raster::for_each_target([&](const auto& row) {
    using Pixel = std::remove_cvref_t<decltype(row.empty)>;
    if constexpr (std::is_constructible_v<FrameImagePixels, Image<Pixel>>)
      if (!row.file.empty()) f(row);
  });
}

/// EXR has no such integers, and no names for two channels.
template <class T>
constexpr bool kHasExr = !std::is_same_v<T, std::int64_t> && !std::is_same_v<T, Vec2>;

}  // namespace

std::string frame_image_names() {
  std::string names;
  each_kind([&](const auto& row) { names.append(names.empty() ? "" : ", ").append(row.file); });
  return names;
}

FrameImage parse_frame_image(const std::string& text) {
  const std::size_t equals = text.find('=');
  const std::string name = text.substr(0, equals);
  std::optional<FrameImage> found;
  each_kind([&]<class T>(const raster::TargetRow<T>& row) {
    if (equals == std::string::npos || name != row.file) return;
    const std::string option = "--image " + name, file = text.substr(equals + 1);
    found = {row.file, kHasExr<T> ? parse_output(option, file, {Format::npy, Format::exr})
                                  : parse_output(option, file, {Format::npy})};
  });
  if (found) return *std::move(found);
  throw UsageError("--image", "expected NAME=FILE with one of the names " + frame_image_names() +
                                  ", got '" + text + "'");
}

void add_frame_images(const std::vector<std::string_view>& images, int width, int height,
                      std::vector<FrameImagePixels>& pixels, Targets& targets) {
  pixels.resize(images.size());
  for (std::size_t i = 0; i < images.size(); ++i)
    each_kind([&]<class T>(const raster::TargetRow<T>& row) {
      if (row.file != images[i]) return;
      if (!std::holds_alternative<Image<T>>(pixels[i]) || std::get<Image<T>>(pixels[i]).empty())
        pixels[i] = Image<T>(width, height);
      targets.*row.image = std::get<Image<T>>(pixels[i]).view();
    });
}

}  // namespace rastrum::cli
