// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "frame/frames.hpp"
#include "job/render_job.hpp"

namespace rastrum::cli {

/// Draws all pictures of the job and writes its files. A sequence's picture is visible as soon as
/// it is drawn, all other files together at the end.
void write_pictures(RenderJob& job, Frames& frames);

}  // namespace rastrum::cli
