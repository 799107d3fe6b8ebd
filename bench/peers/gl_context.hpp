// SPDX-License-Identifier: BSD-3-Clause
// Code that the OpenGL peers share: a context without a window (EGL's surfaceless platform, OpenGL
// 4.5 core, Mesa's llvmpipe), programs, a mesh in static buffers, and `phong` as GLSL.
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

/// The beginning of a fragment shader: `#version`, then `vec3 phong()` of the inputs that
/// `GlContext::mesh_program`'s vertex shader passes on: base (0.8, 0.7, 0.6), both sides lit.
extern const char* const kGlslPhong;

struct GlProgram {
  GLuint name = 0;
  GLint rows = -1, eye = -1;
};

/// One at a time in a process; bound to the thread that made it.
class GlContext {
 public:
  /// Starts llvmpipe on `threads` rasterizing threads (Mesa reads that once a process).
  /// Throws Error{no_device} saying what is missing.
  explicit GlContext(int threads);
  ~GlContext();
  GlContext(const GlContext&) = delete;
  GlContext& operator=(const GlContext&) = delete;

  GlApi gl;

  /// GL_VERSION and GL_RENDERER.
  [[nodiscard]] std::string description() const;
  /// Throws Error if OpenGL has one to tell.
  void check(const char* where) const;
  [[nodiscard]] GLint limit(GLenum what) const;

  /// A program that draws the mesh, and one of any two stages. Throws Error{unsupported} with the
  /// compiler's words. `more`: GLSL that defines what the vertex shader does beside positions,
  /// normals and the way to the viewer.
  [[nodiscard]] GlProgram mesh_program(const std::string& fragment_source,
                                       const std::string& more = "void more() {}") const;
  [[nodiscard]] GLuint program(const std::string& vertex_source,
                               const std::string& fragment_source) const;

  /// Copies positions, indices and the normals that share the positions' indices into static
  /// buffers. Throws Error{invalid_argument} where the normals have indices of their own.
  void set_mesh(const MeshView& mesh);
  /// Points of one pixel instead of a mesh; programs get no normals.
  void set_points(std::span<const Vec3> positions);
  /// Takes `world_to_clip(camera, width, height)`, rounded to float32. Throws Error{unsupported}
  /// where the driver has no framebuffer that large. Returns whether the size is another now.
  bool set_view(const Camera& camera, int width, int height);
  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }

  /// Makes it the current program, with the view.
  void use(const GlProgram& program) const;
  /// Draws the mesh, or points, into the bound framebuffer.
  void draw_mesh(const GlProgram& program) const;

  /// To be called when images have been attached to a new framebuffer. Throws Error{unsupported}
  /// where the driver has none of that size.
  void finish_framebuffer() const;
  /// The bound framebuffer's colours become 0.
  void clear_color() const;
  /// Its depths all become far, to be tested and written.
  void clear_depth() const;
  /// Its pixels; `where` is for an error's message.
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
  GLsizei point_count_ = 0;  ///< 0: a mesh is drawn
  int width_ = 0, height_ = 0;
  Mat4 world_to_clip_{};
  Vec4 eye_{};
};

}  // namespace rastrum::bench
