#include "frame_images.hpp"

#include <type_traits>

#include "arguments.hpp"

namespace rastrum::cli {

struct FrameImageKind {
  const char* name;
  std::variant<ImageView<float> Targets::*, ImageView<std::int64_t> Targets::*,
               ImageView<Vec2> Targets::*, ImageView<Vec3> Targets::*, ImageView<Vec4> Targets::*>
      target;
};

namespace {

constexpr FrameImageKind kKinds[] = {
    {"instances", &Targets::instances},
    {"primitives", &Targets::primitives},
    {"barycentrics", &Targets::barycentrics},
    {"positions", &Targets::positions},
    {"normals", &Targets::normals},
    {"camera-normals", &Targets::camera_normals},
    {"view-depth", &Targets::view_depth},
    {"distance", &Targets::distance},
    {"albedo", &Targets::albedo},
    {"scalars", &Targets::scalars},
    {"linear", &Targets::linear},
};

/// Integers have no EXR, and two channels no names there.
bool has_exr(const FrameImageKind& kind) {
  return !std::holds_alternative<ImageView<std::int64_t> Targets::*>(kind.target) &&
         !std::holds_alternative<ImageView<Vec2> Targets::*>(kind.target);
}

}  // namespace

const char* name(const FrameImage& image) {
  return image.kind->name;
}

std::string frame_image_names() {
  std::string names;
  for (const FrameImageKind& kind : kKinds)
    names.append(names.empty() ? "" : ", ").append(kind.name);
  return names;
}

FrameImage parse_frame_image(const std::string& text) {
  const std::size_t equals = text.find('=');
  const std::string name = text.substr(0, equals);
  for (const FrameImageKind& kind : kKinds) {
    if (equals == std::string::npos || name != kind.name) continue;
    const std::string option = "--image " + name, file = text.substr(equals + 1);
    return {&kind, has_exr(kind) ? parse_output(option, file, {Format::npy, Format::exr})
                                 : parse_output(option, file, {Format::npy})};
  }
  throw UsageError("--image", "expected NAME=FILE with one of the names " + frame_image_names() +
                                  ", got '" + text + "'");
}

void add_frame_images(const std::vector<const FrameImageKind*>& images, int width, int height,
                      std::vector<FrameImagePixels>& pixels, Targets& targets) {
  pixels.resize(images.size());
  for (std::size_t i = 0; i < images.size(); ++i)
    std::visit(
        [&](auto member) {
          auto& view = targets.*member;
          using Pixel = std::remove_pointer_t<decltype(view.data)>;
          if (!std::holds_alternative<Image<Pixel>>(pixels[i]) ||
              std::get<Image<Pixel>>(pixels[i]).empty())
            pixels[i] = Image<Pixel>(width, height);
          view = std::get<Image<Pixel>>(pixels[i]).view();
        },
        images[i]->target);
}

}  // namespace rastrum::cli
