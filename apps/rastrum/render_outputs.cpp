#include "render_outputs.hpp"

#include <cstdio>
#include <string>
#include <utility>
#include <variant>

#include <rastrum/camera.hpp>

#include "heatmap.hpp"
#include "progress.hpp"
#include "timeline.hpp"
#include "transparency.hpp"

namespace rastrum::cli {
namespace {

void report_errors(const RenderArguments& a, const ErrorPicture& picture, std::size_t pixels,
                   Progress& progress) {
  progress.clear();
  if (a.quiet) return;
  const bool repaired = a.render.transparency.method == Transparency::exact;
  std::fprintf(stderr, "%s: %lu of %lu pixels are red: %s\n", a.errors.name().c_str(),
               static_cast<unsigned long>(picture.wrong), static_cast<unsigned long>(pixels),
               repaired ? "the filter could not hold them, and they were sorted"
                        : "blended in a wrong order");
}

/// `depth` in the scene's units.
Image<float> distances(ImageView<const float> depth, const Camera& camera) {
  Image<float> distance(depth.width, depth.height);
  for (int y = 0; y < depth.height; ++y)
    for (int x = 0; x < depth.width; ++x)
      distance(x, y) = static_cast<float>(view_distance(camera, depth(x, y)));
  return distance;
}

template <class Pixel>
ImageView<const Pixel> top(const Image<Pixel>& image, int rows) {
  return {image.view().data, image.width(), rows};
}

}  // namespace

std::vector<Output*> picture_outputs(RenderArguments& a) {
  std::vector<Output*> outputs{&a.color, &a.depth, &a.ids, &a.objects, &a.heatmap, &a.errors};
  for (FrameImage& image : a.images) outputs.push_back(&image.output);
  std::erase_if(outputs, [](const Output* output) { return !*output; });
  return outputs;
}

/// Whether --hash is of the 8-bit colours because no picture is written.
static bool hashes_alone(RenderArguments a) {
  return a.hash && picture_outputs(a).empty();
}

Wanted wanted_of(const RenderArguments& a, const Annotations* notes, Annotator* annotator) {
  const bool floats = a.color.format == Format::exr || a.color.format == Format::npy;
  Wanted wanted{.color8 = (a.color && !floats) || a.errors || hashes_alone(a),
                .color = a.color && floats,
                .depth = static_cast<bool>(a.depth),
                .ids = a.ids || a.objects,
                .overdraw = static_cast<bool>(a.heatmap),
                .errors = static_cast<bool>(a.errors),
                .images = {},
                .notes = notes,
                .annotator = annotator};
  for (const FrameImage& image : a.images) wanted.images.push_back(image.name);
  return wanted;
}

void annotate_pictures(const RenderArguments& a, const Annotations& notes, const Pictures& p,
                       const SceneView& scene, const Camera& camera, Annotator& annotator) {
  if (!p.color8.empty() || !p.color.empty())
    annotator.draw(notes, scene, camera, a.render.background, p.targets);
}

std::vector<OutputImage> output_images(const RenderArguments& a, const Camera& camera,
                                       const Inputs& inputs) {
  using Take = OutputImage::Take;
  std::vector<OutputImage> all;
  const auto add = [&](const Output& output, std::string_view what, auto with) {
    all.push_back({&output, std::string(what), with});
  };
  if (a.color || hashes_alone(a))
    add(a.color, "color", [](const Pictures& p, int rows, const Take& take) {
      if (p.color.empty())
        take(top(p.color8, rows));
      else
        take(top(p.color, rows));
    });
  if (a.depth)
    add(a.depth, "depth", [&a, camera](const Pictures& p, int rows, const Take& take) {
      if (a.depth_unit != DepthUnit::world) return take(top(p.depth, rows));
      const Image<float> in_world = distances(top(p.depth, rows), camera);
      take(top(in_world, rows));
    });
  if (a.ids)
    add(a.ids, "ids",
        [](const Pictures& p, int rows, const Take& take) { take(top(p.ids, rows)); });
  if (a.objects)
    add(a.objects, "objects", [&inputs](const Pictures& p, int rows, const Take& take) {
      const Image<std::int32_t> objects = inputs_of_ids(top(p.ids, rows), inputs.parts);
      take(top(objects, rows));
    });
  for (std::size_t i = 0; i < a.images.size(); ++i)
    add(a.images[i].output, a.images[i].name, [i](const Pictures& p, int rows, const Take& take) {
      std::visit([&](const auto& image) { take(top(image, rows)); }, p.images[i]);
    });
  return all;
}

void write_images(const RenderArguments& a, const Pictures& p, const Camera& camera,
                  const Inputs& inputs, std::optional<std::size_t> number, OutputFiles& files,
                  Timeline& timeline, Progress& progress) {
  const auto write = [&](const Output& output, auto&& writer) {
    if (!output) return;
    progress.show("writing " + output.name());
    timeline.measure("write " + output.name(), "write", [&] { writer(files.begin(output)); });
  };
  const auto hash = [&](const char* what, const auto& image) {
    if (!a.hash) return;
    progress.clear();
    print_hash(digest(image), what, number);
  };
  for (const OutputImage& image : output_images(a, camera, inputs))
    image.with(p, a.render.height, [&](const ImageOfFile& pixels) {
      if (image.output->format != Format::mp4)
        write(*image.output, [&](io::AtomicFile& file) {
          write_image(file, image.output->format, pixels, a.render.threads);
        });
      std::visit([&](const auto& view) { hash(image.what.c_str(), view); }, pixels);
    });
  write(a.heatmap, [&](io::AtomicFile& file) {
    const Heatmap heatmap = make_heatmap(p.overdraw.view());
    io::write_png(file, heatmap.image.view());
    hash("heatmap", heatmap.image);
    progress.clear();
    if (!a.quiet)
      std::fprintf(stderr,
                   "heatmap: black 0, dark violet 1, light yellow %lu fragments at a pixel, "
                   "logarithmic; %lu fragments in all\n",
                   static_cast<unsigned long>(heatmap.max),
                   static_cast<unsigned long>(heatmap.sum));
  });
  write(a.errors, [&](io::AtomicFile& file) {
    const ErrorPicture picture = make_error_picture(p.color8.view(), p.errors.view());
    io::write_png(file, picture.image.view());
    hash("errors", picture.image);
    report_errors(a, picture, p.errors.pixels().size(), progress);
  });
}

}  // namespace rastrum::cli
