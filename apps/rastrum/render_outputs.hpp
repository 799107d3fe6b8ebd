// From the pictures of `rastrum render` to its files.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <rastrum/annotate.hpp>

#include "inputs.hpp"
#include "output.hpp"
#include "render_arguments.hpp"
#include "render_job.hpp"

namespace rastrum::cli {

/// The outputs that hold one picture, so that a sequence needs a numbered name for each; those that
/// are asked for.
[[nodiscard]] std::vector<Output*> picture_outputs(RenderArguments& a);

/// The images that they are made of.
[[nodiscard]] Wanted wanted_of(const RenderArguments& a, const Annotations* notes = nullptr,
                               Annotator* annotator = nullptr);

/// Words and effects, into the colours alone.
void annotate_pictures(const RenderArguments& a, const Annotations& notes, const Pictures& p,
                       const SceneView& scene, const Camera& camera, Annotator& annotator);

/// An output of one picture, and which of the picture's images it holds.
struct OutputImage {
  const Output* output;
  std::string what;  ///< as --hash calls it
  using Take = std::function<void(const ImageOfFile&)>;
  /// Calls `take` with the first `rows` rows of its image, which may be made for that.
  std::function<void(const Pictures&, int rows, const Take& take)> with;
};
/// The colours, depth, ids, objects and --image that are asked for, in this order; with --hash
/// alone the colours, too, without an output. `a` and `inputs` (only its parts are read) must
/// outlive them.
[[nodiscard]] std::vector<OutputImage> output_images(const RenderArguments& a, const Camera& camera,
                                                     const Inputs& inputs);

/// Writes into `files`, which the caller commits. `number`: the picture's, where there are many.
/// Only the parts of `inputs` are read.
void write_images(const RenderArguments& a, const Pictures& p, const Camera& camera,
                  const Inputs& inputs, std::optional<std::size_t> number, OutputFiles& files,
                  Timeline& timeline, Progress& progress);

}  // namespace rastrum::cli
