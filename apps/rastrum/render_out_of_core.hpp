// `rastrum render` of a file that is larger than memory: it is mapped, and drawn in chunks.
#pragma once

#include <optional>

#include <rastrum/out_of_core.hpp>

#include "render_arguments.hpp"

namespace rastrum::cli {

class Progress;
class Timeline;

/// The input, where it is to be drawn so: RenderArguments::out_of_core says `always`, or
/// `automatic` and the one INPUT takes more than the memory limit. A file of a kind that is not
/// drawn so is read then, with a warning. Throws what is wrong with the file.
[[nodiscard]] std::optional<OutOfCoreFile> large_input(const RenderArguments& a);

/// Returns the exit status. Options that need all of the mesh are refused by name.
[[nodiscard]] int render_out_of_core(RenderArguments& a, const OutOfCoreFile& file,
                                     Timeline& timeline, Progress& progress);

}  // namespace rastrum::cli
