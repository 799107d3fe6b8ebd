// From the pictures of `rastrum render` to its files.
#pragma once

#include <cstddef>
#include <optional>
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

/// `depth` in the scene's units.
[[nodiscard]] Image<float> distances(ImageView<const float> depth, const Camera& camera);

/// Into `files`, which the caller commits. `number`: of a picture of many. Of `inputs` the parts.
void write_images(const RenderArguments& a, const Pictures& p, const Camera& camera,
                  const Inputs& inputs, std::optional<std::size_t> number, OutputFiles& files,
                  Timeline& timeline, Progress& progress);

}  // namespace rastrum::cli
