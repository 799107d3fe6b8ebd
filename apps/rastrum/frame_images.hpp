// The images of a frame beside its picture that `--image NAME=FILE` writes: what is seen at each
// pixel (docs/conventions.md, "Outputs").
#pragma once

#include <string>
#include <variant>
#include <vector>

#include <rastrum/frame.hpp>

#include "output.hpp"

namespace rastrum::cli {

struct FrameImageKind;

/// One that is asked for.
struct FrameImage {
  const FrameImageKind* kind;
  Output output;
};

/// NAME=FILE. Throws UsageError that lists the names.
[[nodiscard]] FrameImage parse_frame_image(const std::string& text);
/// As on the command line.
[[nodiscard]] const char* name(const FrameImage& image);
/// The names, for help texts.
[[nodiscard]] std::string frame_image_names();

using FrameImagePixels =
    std::variant<Image<float>, Image<std::int64_t>, Image<Vec2>, Image<Vec3>, Image<Vec4>>;
/// Allocates what `images` want, in their order, and names it in `targets`.
void add_frame_images(const std::vector<const FrameImageKind*>& images, int width, int height,
                      std::vector<FrameImagePixels>& pixels, Targets& targets);

}  // namespace rastrum::cli
