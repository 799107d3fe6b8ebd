#include "picture_files.hpp"

#include <algorithm>
#include <type_traits>
#include <utility>
#include <variant>

#include "render_outputs.hpp"

namespace rastrum::cli {
namespace {

/// What a rank holds of a pixel beside targets: keys, words, those of others, and as they travel.
constexpr std::uint64_t kBytesOfWords = 48;
/// Of a sample, where there are several: a fragment as it is held, packed, and received.
constexpr std::uint64_t kBytesOfSample = 3 * 24;
/// Bands are whole bins (RanksOptions::rows).
constexpr int kStep = 64;

io::PictureRows::Format rows_format(Format format) {
  switch (format) {
    case Format::png:
      return io::PictureRows::Format::png;
    case Format::exr:
      return io::PictureRows::Format::exr;
    default:
      return io::PictureRows::Format::npy;
  }
}

template <class Pixel>
ImageView<const Pixel> top(const Image<Pixel>& image, int rows) {
  return {image.view().data, image.width(), rows};
}

}  // namespace

int rows_at_once(const RenderArguments& a, std::uint64_t bytes) {
  const Wanted wanted = wanted_of(a);
  // An image more for linear light and its depth, where colours have a tone.
  std::uint64_t of_pixel = kBytesOfWords + sizeof(Vec4) + sizeof(float);
  of_pixel += wanted.color8 ? sizeof(Rgba8) : 0;
  of_pixel += wanted.color ? sizeof(Vec4) : 0;
  of_pixel += wanted.depth ? sizeof(float) : 0;
  of_pixel += wanted.ids ? sizeof(std::int64_t) : 0;
  of_pixel += wanted.images.size() * sizeof(Vec4);
  if (a.render.samples > 1)
    of_pixel += kBytesOfSample * static_cast<std::uint64_t>(a.render.samples);
  const std::uint64_t of_step = of_pixel * kStep * static_cast<std::uint64_t>(a.render.width);
  const std::uint64_t steps = std::max<std::uint64_t>(bytes / of_step, 1);
  const auto height = static_cast<std::uint64_t>(a.render.height);
  return steps * kStep >= height ? 0 : static_cast<int>(steps) * kStep;
}

template <class F>
void PictureFiles::begin(const Output& output, const F& add) {
  if (!output) return;
  files_.push_back({io::PictureRows(outputs_.begin(output), rows_format(output.format),
                                    a_.render.width, a_.render.height, a_.render.threads),
                    add});
}

PictureFiles::PictureFiles(const RenderArguments& a, const Camera& camera, const Inputs& inputs,
                           OutputFiles& files)
    : a_(a), outputs_(files) {
  begin(a.color, [](io::PictureRows& to, const Pictures& p, int rows) {
    if (!p.color.empty())
      to.add(top(p.color, rows));
    else
      to.add(top(p.color8, rows));
  });
  begin(a.depth, [&a, camera](io::PictureRows& to, const Pictures& p, int rows) {
    if (a.depth_unit != DepthUnit::world) return to.add(top(p.depth, rows));
    const Image<float> in_world = distances(top(p.depth, rows), camera);
    to.add(in_world.view());
  });
  begin(a.ids, [](io::PictureRows& to, const Pictures& p, int rows) { to.add(top(p.ids, rows)); });
  begin(a.objects, [&inputs](io::PictureRows& to, const Pictures& p, int rows) {
    const Image<std::int32_t> objects = inputs_of_ids(top(p.ids, rows), inputs.parts);
    to.add(objects.view());
  });
  for (std::size_t i = 0; i < a.images.size(); ++i)
    begin(a.images[i].output, [i](io::PictureRows& to, const Pictures& p, int rows) {
      std::visit([&](const auto& image) { to.add(top(image, rows)); }, p.images[i]);
    });
}

void PictureFiles::add(const Pictures& band, int rows) {
  for (File& file : files_) file.add(file.rows, band, rows);
}

void PictureFiles::finish() {
  for (File& file : files_) file.rows.finish();
}

}  // namespace rastrum::cli
