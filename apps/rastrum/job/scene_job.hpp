// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "render_job.hpp"
#include "sequence.hpp"

namespace rastrum::cli {

struct SceneJob : RenderJob {
  /// Reads the inputs once they are known to be drawable. Throws Error, UsageError.
  explicit SceneJob(const RenderArguments& a);

  Renderer renderer;
  Inputs inputs;
  std::optional<SceneBinding> binding;
  Sequence pictures;  ///< one, unless --path or --turntable gives more

 private:
  [[nodiscard]] bool pose_first();
  [[nodiscard]] std::size_t animation() const;
  void light();
  void warn_of_inputs();

  std::optional<SceneBinding> posed_;
};

}  // namespace rastrum::cli
