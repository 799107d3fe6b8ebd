// SPDX-License-Identifier: BSD-3-Clause
// Shared by the OpenGL peers: a context without a window (EGL's surfaceless platform, OpenGL 4.5
// core, Mesa's llvmpipe), programs, a mesh in static buffers, and `phong` in GLSL.
#pragma once

#include <EGL/egl.h>

#include <span>
#include <string>

#include <rastrum/camera.hpp>
#include <rastrum/image.hpp>
#include <rastrum/mat.hpp>
#include <rastrum/mesh.hpp>

#include "gl_api.hpp"

namespace rastrum::bench {

/// The start of a fragment shader: `#version`, then `vec3 phong()`, base (0.8, 0.7, 0.6), both
/// sides lit. It reads the outputs of `GlContext::mesh_program`'s vertex shader.
extern const char* const kGlslPhong;

struct GlProgram {
  GLuint name = 0;
  GLint rows = -1, eye = -1;
};

/// Only one at a time in a process; bound to the thread that made it.
class GlContext {
 public:
  /// Starts llvmpipe on `threads` rasterizing threads (Mesa reads that once a process). Throws
  /// Error{no_device}, which says what is missing.
  explicit GlContext(int threads);
  ~GlContext();
  GlContext(const GlContext&) = delete;
  GlContext& operator=(const GlContext&) = delete;

  GlApi gl;

  /// GL_VERSION and GL_RENDERER.
  [[nodiscard]] std::string description() const;
  /// Throws Error if OpenGL reports one.
  void check(const char* where) const;
  [[nodiscard]] GLint limit(GLenum what) const;

  /// Compiles a program that draws the mesh, or one of any two stages. Throws Error{unsupported}
  /// with the compiler's message. `more` is GLSL for what the vertex shader computes beside
  /// positions, normals and the direction to the viewer.
  [[nodiscard]] GlProgram mesh_program(const std::string& fragment_source,
                                       const std::string& more = "void more() {}") const;
  [[nodiscard]] GLuint program(const std::string& vertex_source,
                               const std::string& fragment_source) const;

  /// Copies positions, indices and normals into static buffers. Throws Error{invalid_argument}
  /// unless the normals share the positions' indices.
  void set_mesh(const MeshView& mesh);
  /// Takes points of one pixel instead of a mesh; programs get no normals.
  void set_points(std::span<const Vec3> positions);
  /// Takes `world_to_clip(camera, width, height)`, rounded to float32. Returns whether the size has
  /// changed. Throws Error{unsupported} if the driver has no framebuffer that large.
  bool set_view(const Camera& camera, int width, int height);
  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }

  /// Makes `program` current and sets the view.
  void use(const GlProgram& program) const;
  /// Draws the mesh or the points into the bound framebuffer.
  void draw_mesh(const GlProgram& program) const;

  /// Call this after attaching images to a new framebuffer. Throws Error{unsupported} if the driver
  /// has none of that size.
  void finish_framebuffer() const;
  /// Clears the bound framebuffer's colours to 0.
  void clear_color() const;
  /// Clears its depths to far and turns depth test and writes on.
  void clear_depth() const;
  /// Reads its pixels; `where` is for an error's message.
  template <class T>
  [[nodiscard]] Image<T> read(GLenum format, GLenum type, const char* where) const {
    Image<T> image(width_, height_);
    gl.ReadPixels(0, 0, width_, height_, format, type, image.pixels().data());
    check(where);
    return image;
  }

 private:
  void start_egl();
  void stop_egl();
  [[nodiscard]] GLuint shader(GLenum stage, const std::string& source) const;

  EGLDisplay display_ = EGL_NO_DISPLAY;
  EGLContext context_ = EGL_NO_CONTEXT;
  GLuint buffers_[2] = {};  // vertices, indices
  GLsizei index_count_ = 0;
  GLsizei point_count_ = 0;  ///< 0: draws the mesh
  int width_ = 0, height_ = 0;
  Mat4 world_to_clip_{};
  Vec4 eye_{};
};

}  // namespace rastrum::bench
