// SPDX-License-Identifier: BSD-3-Clause
// Tone mapping: a pass over the finished linear light of a frame.
#pragma once

#include <rastrum/frame.hpp>
#include <rastrum/image.hpp>
#include <rastrum/parallel/exec.hpp>
#include <rastrum/render.hpp>

namespace rastrum {

/// Throws Error{invalid_argument} for an unknown curve and for an exposure out of range.
void check_tone(const ToneMapping& mapping);

class ToneCurve {
 public:
  explicit ToneCurve(const ToneMapping& mapping);
  /// Display values in [0, 1].
  [[nodiscard]] Vec3 operator()(Vec3 linear) const;

 private:
  Tone tone_;
  float exposure_;
};

/// Holds the images of one frame that the pass needs and the caller did not ask for.
class TonePass {
 public:
  /// Whether the frame is tone mapped. `taken`: its resolved shader. Throws Error{invalid_argument}
  /// unless that is `material`, Error{unsupported} for a pass over a picture.
  [[nodiscard]] static bool wanted(const FrameOptions& frame, const Targets& targets, Shader taken,
                                   const Pass& pass = {});

  /// `asked` with linear light and depth instead of colours.
  [[nodiscard]] Targets targets(const FrameOptions& frame, const Targets& asked);
  /// Fills the colours of `asked` from the contents of targets(). Where nothing is seen, the
  /// background stays.
  void draw(const FrameOptions& frame, const Targets& asked, parallel::Threads* threads) const;

 private:
  Image<Vec4> own_linear_;
  Image<float> own_depth_;
  ImageView<const Vec4> linear_;
  ImageView<const float> depth_;
};

}  // namespace rastrum
