// SPDX-License-Identifier: BSD-3-Clause
#include "gl_target.hpp"

namespace rastrum::bench {

void GlTarget::release(const GlContext& context) {
  const GlApi& gl = context.gl;
  gl.DeleteFramebuffers(1, &framebuffer_);
  gl.DeleteRenderbuffers(1, &color_);
  gl.DeleteRenderbuffers(1, &depth_);
  framebuffer_ = color_ = depth_ = 0;
}

void GlTarget::bind(const GlContext& context) {
  const GlApi& gl = context.gl;
  if (framebuffer_ != 0) {
    gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
    return;
  }
  gl.GenFramebuffers(1, &framebuffer_);
  gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  const int width = context.width(), height = context.height();
  const auto attach = [&](GLuint& buffer, GLenum internal, GLenum where) {
    gl.GenRenderbuffers(1, &buffer);
    gl.BindRenderbuffer(GL_RENDERBUFFER, buffer);
    gl.RenderbufferStorage(GL_RENDERBUFFER, internal, width, height);
    gl.FramebufferRenderbuffer(GL_FRAMEBUFFER, where, GL_RENDERBUFFER, buffer);
  };
  attach(color_, color_format_, GL_COLOR_ATTACHMENT0);
  attach(depth_, GL_DEPTH_COMPONENT32F, GL_DEPTH_ATTACHMENT);
  context.finish_framebuffer();
}

}  // namespace rastrum::bench
