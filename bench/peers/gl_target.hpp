// SPDX-License-Identifier: BSD-3-Clause
// The target of the OpenGL peers for opaque things: a framebuffer object of renderbuffers.
#pragma once

#include "gl_context.hpp"

namespace rastrum::bench {

/// One colour format, and 32-bit float depth.
class GlTarget {
 public:
  explicit GlTarget(GLenum color_format) : color_format_(color_format) {}

  /// Binds it, made of the view's size at its first use. Throws Error{unsupported} where the driver
  /// has no such framebuffer.
  void bind(const GlContext& context);
  /// After a change of the view's size.
  void release(const GlContext& context);

 private:
  GLenum color_format_;
  GLuint framebuffer_ = 0, color_ = 0, depth_ = 0;
};

}  // namespace rastrum::bench
