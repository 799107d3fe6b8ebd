// SPDX-License-Identifier: BSD-3-Clause
// The images of a frame that `--image NAME=FILE` writes (docs/outputs.md).
#pragma once

#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <rastrum/frame.hpp>

#include "output.hpp"

namespace rastrum::cli {

struct FrameImage {
  std::string_view name;  ///< as on the command line
  Output output;
};

/// NAME=FILE. Throws UsageError that lists the names.
[[nodiscard]] FrameImage parse_frame_image(const std::string& text);
/// For help texts.
[[nodiscard]] std::string frame_image_names();

using FrameImagePixels =
    std::variant<Image<float>, Image<std::int64_t>, Image<Vec2>, Image<Vec3>, Image<Vec4>>;
/// Allocates these images in their order and puts them into `targets`.
void add_frame_images(const std::vector<std::string_view>& images, int width, int height,
                      std::vector<FrameImagePixels>& pixels, Targets& targets);

}  // namespace rastrum::cli
