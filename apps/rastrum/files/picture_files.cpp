// SPDX-License-Identifier: BSD-3-Clause
#include "picture_files.hpp"

#include <cstdio>
#include <map>
#include <memory>
#include <optional>
#include <variant>

#include <rastrum/camera.hpp>

#include "frame/heatmap.hpp"
#include "job/json_file.hpp"
#include "mp4.hpp"
#include "output_files.hpp"

namespace rastrum::cli {
namespace {

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

/// Calls take(output, name, the first rows of its image) for the wanted colours, depth, ids,
/// objects and --image; with --hash alone for the colours, too.
template <class Take>
void for_each_image(const RenderJob& job, const PictureOutputs& o, const Pictures& p, int rows,
                    const Take& take) {
  const RenderArguments& a = job.arguments;
  const bool has_colors = o.color || a.hashes_alone();
  if (has_colors && p.color.empty()) take(o.color, "color", top(p.color8, rows));
  if (has_colors && !p.color.empty()) take(o.color, "color", top(p.color, rows));
  if (o.depth && a.depth_unit != DepthUnit::world) take(o.depth, "depth", top(p.depth, rows));
  if (o.depth && a.depth_unit == DepthUnit::world)
    take(o.depth, "depth", top(distances(top(p.depth, rows), p.camera), rows));
  if (o.ids) take(o.ids, "ids", top(p.ids, rows));
  if (o.objects) take(o.objects, "objects", top(inputs_of_ids(top(p.ids, rows), job.parts), rows));
  for (std::size_t i = 0; i < o.images.size(); ++i)
    std::visit(
        [&](const auto& image) { take(o.images[i].output, o.images[i].name, top(image, rows)); },
        p.images[i]);
}

/// The caller commits. `number`: the picture's, if there are many.
void write_images(RenderJob& job, const PictureOutputs& o, const Pictures& p,
                  std::optional<std::size_t> number, OutputFiles& files) {
  const auto write = [&](const Output& output, auto&& writer) {
    if (!output) return;
    job.progress.show("writing " + output.name());
    job.timeline.measure("write " + output.name(), "write", [&] { writer(files.begin(output)); });
  };
  const auto hash = [&](std::string_view what, const auto& image) {
    if (!job.arguments.hash) return;
    job.progress.clear();
    print_hash(digest(image), what, number);
  };
  for_each_image(job, o, p, job.render.height,
                 [&](const Output& output, std::string_view what, const ImageOfFile& pixels) {
                   if (output.format != Format::mp4)
                     write(output, [&](io::AtomicFile& file) {
                       write_image(file, output.format, pixels, job.render.threads);
                     });
                   std::visit([&](const auto& view) { hash(what, view); }, pixels);
                 });
  write(o.heatmap, [&](io::AtomicFile& file) {
    const Heatmap heatmap = make_heatmap(p.overdraw.view());
    io::write_png(file, heatmap.image.view());
    hash("heatmap", heatmap.image);
    job.progress.clear();
    if (!job.quiet)
      std::fprintf(stderr,
                   "heatmap: black 0, dark violet 1, light yellow %lu fragments at a pixel, "
                   "logarithmic; %lu fragments in all\n",
                   static_cast<unsigned long>(heatmap.max),
                   static_cast<unsigned long>(heatmap.sum));
  });
  write(o.errors, [&](io::AtomicFile& file) {
    const ErrorPicture picture = make_error_picture(p.color8.view(), p.errors.view());
    io::write_png(file, picture.image.view());
    hash("errors", picture.image);
    job.progress.clear();
    if (!job.quiet)
      std::fprintf(stderr, "%s: %lu of %lu pixels are red: %s\n", o.errors.name().c_str(),
                   static_cast<unsigned long>(picture.wrong),
                   static_cast<unsigned long>(p.errors.pixels().size()),
                   job.render.transparency.method == Transparency::exact
                       ? "the filter could not hold them, and they were sorted"
                       : "blended in a wrong order");
  });
}

/// The files of one picture that comes in bands of rows, and is never held as a whole.
class BandFiles {
 public:
  BandFiles(const RenderJob& job, OutputFiles& files) : job_(job) {
    using Rows = io::PictureRows;
    for (const Output* const output : job.arguments.outputs.asked_for())
      rows_.try_emplace(output, files.begin(*output),
                        output->format == Format::png   ? Rows::Format::png
                        : output->format == Format::exr ? Rows::Format::exr
                                                        : Rows::Format::npy,
                        job.render.width, job.render.height, job.render.threads);
  }
  void add(const Pictures& band, int rows) {
    for_each_image(job_, job_.arguments.outputs, band, rows,
                   [&](const Output& output, std::string_view, const ImageOfFile& pixels) {
                     std::visit([&](const auto& view) { rows_.at(&output).add(view); }, pixels);
                   });
  }
  void finish() {
    for (auto& [output, rows] : rows_) rows.finish();
  }

 private:
  const RenderJob& job_;
  std::map<const Output*, io::PictureRows> rows_;
};

}  // namespace

void write_pictures(RenderJob& job, Frames& frames) {
  const RenderArguments& a = job.arguments;
  const bool is_sequence = a.is_sequence();
  const Output* const of_run[] = {&a.stats, &a.trace};
  if (is_sequence) check_numbered(a.outputs.asked_for(), of_run, frames.count);
  OutputFiles files;
  std::unique_ptr<Mp4Writer> video;
  if (a.outputs.color.is_film())
    video = std::make_unique<Mp4Writer>(files.begin(a.outputs.color), job.render.width,
                                        job.render.height, a.pictures_a_second());
  std::optional<BandFiles> bands;
  if (frames.rows != 0) job.in_writer("begin files", [&] { bands.emplace(job, files); });

  Pictures pictures;
  for (std::size_t i = 0; i < frames.count; ++i) {
    frames.draw(i, pictures, [&](int rows) { bands->add(pictures, rows); });
    if (!is_sequence) continue;
    OutputFiles of_picture;
    write_images(job, a.outputs.numbered(i, frames.count), pictures, i, of_picture);
    of_picture.commit();
    if (video) video->add(pictures.color8.view());
  }
  if (video) video->finish();
  const Frames::Account account = frames.account();
  job.in_writer("write files", [&] {
    if (bands)
      bands->finish();
    else if (!is_sequence)
      write_images(job, a.outputs, pictures, {}, files);
    job.progress.clear();
    if (a.stats) write_json(files.begin(a.stats), account.stats);
    if (a.trace) write_trace(files.begin(a.trace), job.timeline);
    files.commit();
    if (!job.quiet && a.outputs.color)
      std::fprintf(stderr, "%s: %s\n", a.outputs.color.name().c_str(), account.summary.c_str());
  });
}

}  // namespace rastrum::cli
