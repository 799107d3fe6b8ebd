// Framebuffers of the OpenGL peers; see the header.
#include "gl_target.hpp"

#include <string>

#include <rastrum/error.hpp>

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
  if (gl.CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    throw Error(Errc::unsupported, "OpenGL: no framebuffer of " + std::to_string(width) + "x" +
                                       std::to_string(height));
  gl.ReadBuffer(GL_COLOR_ATTACHMENT0);
  context.check("framebuffer");
}

void clear_depth(const GlContext& context) {
  const GLfloat far_depth = 0;
  context.gl.Enable(GL_DEPTH_TEST);
  context.gl.DepthMask(GL_TRUE);
  context.gl.ClearBufferfv(GL_DEPTH, 0, &far_depth);
}

}  // namespace rastrum::bench
