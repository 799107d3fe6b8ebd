// SPDX-License-Identifier: BSD-3-Clause
// A job of a file that is larger than memory: it is mapped, and drawn in chunks.
#pragma once

#include <optional>

#include <rastrum/out_of_core.hpp>

#include "render_job.hpp"

namespace rastrum::cli {

/// The input, where it is to be drawn so: RenderArguments::out_of_core says `always`, or
/// `automatic` and the one INPUT takes more than the memory limit. A file of a kind that is not
/// drawn so is read then, with a warning. Throws what is wrong with the file, and refuses options
/// that need all of the mesh by name.
[[nodiscard]] std::optional<OutOfCoreFile> large_input(const RenderArguments& a);

struct LargeJob : RenderJob {
  /// Fits the camera to `file`, which must outlive it.
  LargeJob(const RenderArguments& a, const OutOfCoreFile& file);

  const OutOfCoreFile& file;
  OutOfCoreOptions options;
  double fit_ms = 0;
};

}  // namespace rastrum::cli
