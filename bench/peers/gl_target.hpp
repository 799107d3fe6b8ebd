// SPDX-License-Identifier: BSD-3-Clause
// The OpenGL peers' target for opaque surfaces: a framebuffer object of renderbuffers.
#pragma once

#include "gl_context.hpp"

namespace rastrum::bench {

/// Has one colour format and 32-bit float depth.
class GlTarget {
 public:
  explicit GlTarget(GLenum color_format) : color_format_(color_format) {}

  /// Binds the target. The first call makes it, in the view's size. Throws Error{unsupported} if
  /// the driver has no such framebuffer.
  void bind(const GlContext& context);
  /// Call this after the view's size has changed.
  void release(const GlContext& context);

 private:
  GLenum color_format_;
  GLuint framebuffer_ = 0, color_ = 0, depth_ = 0;
};

}  // namespace rastrum::bench
