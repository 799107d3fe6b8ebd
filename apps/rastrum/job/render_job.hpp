// SPDX-License-Identifier: BSD-3-Clause
// A job of `rastrum render`: inputs are opened, and lights, shader and camera that depend on them
// are decided.
#pragma once

#include <functional>
#include <string_view>
#include <vector>

#include <rastrum/annotate.hpp>
#include <rastrum/family.hpp>

#include "inputs.hpp"
#include "parse/render_arguments.hpp"
#include "progress.hpp"

namespace rastrum::cli {

struct RenderJob {
  RenderJob(const RenderArguments& a, bool is_quiet)
      : arguments(a),
        quiet(is_quiet),
        render(a.render),
        notes(meant(a.annotations)),
        progress(is_quiet) {}
  virtual ~RenderJob() = default;
  RenderJob(const RenderJob&) = delete;
  RenderJob& operator=(const RenderJob&) = delete;

  /// Calls f in the process that writes the files; all processes throw what it throws, in `phase`.
  virtual void in_writer(std::string_view /*phase*/, const std::function<void()>& f) { f(); }

  const RenderArguments& arguments;
  bool quiet;
  family::Options render;  ///< the arguments, adapted to the inputs and to a rank
  Annotations notes;
  Camera camera;                 ///< of the first picture
  std::vector<InputPart> parts;  ///< of all inputs
  double load_ms = 0;
  Timeline timeline;
  Progress progress;
};

}  // namespace rastrum::cli
