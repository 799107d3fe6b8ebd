// The files of one picture that comes in bands of rows, so that it is nowhere held as a whole.
#pragma once

#include <vector>

#include <rastrum/camera.hpp>

#include "inputs.hpp"
#include "output.hpp"
#include "render_arguments.hpp"
#include "render_job.hpp"
#include "render_outputs.hpp"

namespace rastrum::cli {

/// How many rows of the picture are drawn and written at once, so that what ranks hold of it stays
/// within `bytes`; 0: all. Images that look at a whole picture are not asked about here.
[[nodiscard]] int rows_at_once(const RenderArguments& a, std::uint64_t bytes);

/// The options that need a whole picture, as the begin of "… a whole picture"; null: none, so that
/// it can be drawn in bands.
[[nodiscard]] const char* why_whole(const RenderArguments& a, const Annotations& notes);

/// Begins the files of all images that `a` asks for; who calls commits `files`. `a` and `inputs`
/// must outlive it.
class PictureFiles {
 public:
  PictureFiles(const RenderArguments& a, const Camera& camera, const Inputs& inputs,
               OutputFiles& files);
  /// The first `rows` rows of images are the picture's next.
  void add(const Pictures& band, int rows);
  /// All rows have come.
  void finish();

 private:
  struct File {
    io::PictureRows rows;
    OutputImage image;
  };
  std::vector<File> files_;
};

}  // namespace rastrum::cli
