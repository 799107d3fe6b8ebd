// SPDX-License-Identifier: BSD-3-Clause
// Draws the environment behind a scene, as a pass over a frame without background.
#pragma once

#include <rastrum/camera.hpp>
#include <rastrum/frame.hpp>
#include <rastrum/image.hpp>
#include <rastrum/parallel/exec.hpp>
#include <rastrum/render.hpp>

namespace rastrum {

/// Holds the images of one frame that the pass needs and the caller did not ask for.
class SurroundingsPass {
 public:
  /// Whether the frame has FrameOptions::environment_behind and a target that shows it. Throws
  /// Error{invalid_argument} if no light is an environment, Error{unsupported} for a pass over a
  /// picture.
  [[nodiscard]] static bool wanted(const FrameOptions& frame, const Targets& targets,
                                   const Pass& pass);

  /// `asked` with float32 colours instead of 8-bit ones, so that colours are rounded only once.
  [[nodiscard]] Targets targets(const FrameOptions& frame, const Targets& asked);
  /// Puts the environments behind the contents of targets() and fills all colours of `asked`.
  void draw(const FrameOptions& frame, const Camera& camera, const Targets& asked,
            parallel::Threads* threads) const;

 private:
  Image<Vec4> own_color_;
  ImageView<Vec4> color_;
};

}  // namespace rastrum
