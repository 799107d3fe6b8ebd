// SPDX-License-Identifier: BSD-3-Clause
// A job whose inputs are in memory.
#pragma once

#include <optional>

#include "render_job.hpp"
#include "sequence.hpp"

namespace rastrum::cli {

struct SceneJob : RenderJob {
  /// Reads the inputs, once it is known that they can be drawn. Throws Error, UsageError.
  explicit SceneJob(const RenderArguments& a);

  Renderer renderer;
  Inputs inputs;
  std::optional<SceneBinding> binding;
  Sequence pictures;  ///< of one, where neither --path nor --turntable says more

 private:
  [[nodiscard]] bool pose_first();
  [[nodiscard]] std::size_t animation() const;
  void light();
  void warn_of_inputs();

  std::optional<SceneBinding> posed_;
};

}  // namespace rastrum::cli
