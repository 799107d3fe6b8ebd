// SPDX-License-Identifier: BSD-3-Clause
// A job for a file larger than memory: it is mapped, and drawn in chunks.
#pragma once

#include <optional>

#include <rastrum/out_of_core.hpp>

#include "render_job.hpp"

namespace rastrum::cli {

/// The input if it is to be drawn out of core: RenderArguments::out_of_core says `always`, or
/// `automatic` and the one INPUT takes more than the memory limit. A file of another kind is read,
/// with a warning. Throws for a wrong file, and refuses options that need the whole mesh, by name.
[[nodiscard]] std::optional<OutOfCoreFile> large_input(const RenderArguments& a);

struct LargeJob : RenderJob {
  /// Fits the camera to `file`, which must outlive it.
  LargeJob(const RenderArguments& a, const OutOfCoreFile& file);

  const OutOfCoreFile& file;
  OutOfCoreOptions options;
  double fit_ms = 0;
};

}  // namespace rastrum::cli
