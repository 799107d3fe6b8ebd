#include "picture_files.hpp"

#include <algorithm>
#include <utility>
#include <variant>

namespace rastrum::cli {
namespace {

/// Bytes that a rank holds of a pixel beside its targets: keys, words, other ranks' words, and
/// words on their way.
constexpr std::uint64_t kBytesOfWords = 48;
/// Bytes of a sample, where there are several: a fragment as it is held, packed, and received.
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

const char* why_whole(const RenderArguments& a, const Annotations& notes) {
  if (notes.any()) return "words and effects are drawn over";
  if (a.render.shader == Shader::depth) return "the shader depth stretches";
  if (a.render.environment_behind) return "an environment is seen behind";
  return a.hash ? "--hash is of" : nullptr;
}

PictureFiles::PictureFiles(const RenderArguments& a, const Camera& camera, const Inputs& inputs,
                           OutputFiles& files) {
  for (OutputImage& image : output_images(a, camera, inputs)) {
    const Output& output = *image.output;
    if (!output) continue;
    files_.push_back({io::PictureRows(files.begin(output), rows_format(output.format),
                                      a.render.width, a.render.height, a.render.threads),
                      std::move(image)});
  }
}

void PictureFiles::add(const Pictures& band, int rows) {
  for (File& file : files_)
    file.image.with(band, rows, [&](const ImageOfFile& pixels) {
      std::visit([&](const auto& view) { file.rows.add(view); }, pixels);
    });
}

void PictureFiles::finish() {
  for (File& file : files_) file.rows.finish();
}

}  // namespace rastrum::cli
