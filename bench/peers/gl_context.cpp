// SPDX-License-Identifier: BSD-3-Clause
// The OpenGL peers' context; see the header. The vertex shader multiplies the matrix in the order
// of transform_point, so that clip coordinates equal Rastrum's, and flips y, so that row 0 is the
// top. glClipControl(GL_UPPER_LEFT) would flip too, but with it Mesa 22.3 gives samples on
// horizontal edges to the triangle above (the bottom-left rule), as drawing such triangles showed.
#include "gl_context.hpp"

#include <EGL/eglext.h>

#include <cstdlib>
#include <numeric>
#include <vector>

namespace rastrum::bench {
namespace {

constexpr const char* kVertexShader = R"(#version 450 core
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
uniform vec4 rows[4];
uniform vec4 eye;
out vec3 n;
out vec3 v;
void more();
void main() {
  precise vec4 clip;
  clip.x = ((rows[0].x * position.x + rows[0].y * position.y) + rows[0].z * position.z) + rows[0].w;
  clip.y = ((rows[1].x * position.x + rows[1].y * position.y) + rows[1].z * position.z) + rows[1].w;
  clip.z = ((rows[2].x * position.x + rows[2].y * position.y) + rows[2].z * position.z) + rows[2].w;
  clip.w = ((rows[3].x * position.x + rows[3].y * position.y) + rows[3].z * position.z) + rows[3].w;
  gl_Position = vec4(clip.x, -clip.y, clip.z, clip.w);
  n = normal;
  v = eye.xyz - eye.w * position;
  more();
}
)";

}  // namespace

// v points to the viewer: eye − position, or one direction for an orthographic camera (eye.w = 0).
const char* const kGlslPhong = R"(#version 450 core
in vec3 n;
in vec3 v;
vec3 phong() {
  vec3 to_eye = normalize(v);
  vec3 normal = normalize(n);
  if (dot(normal, to_eye) < 0.0) normal = -normal;
  vec3 light = normalize(vec3(0.4, 0.6, 1.0));
  vec3 halfway = normalize(light + to_eye);
  float diffuse = 0.1 + 0.8 * max(dot(normal, light), 0.0);
  float highlight = 0.3 * pow(max(dot(normal, halfway), 0.0), 32.0);
  return vec3(0.8, 0.7, 0.6) * diffuse + highlight;
}
)";

GlContext::GlContext(int threads) {
  setenv("LP_NUM_THREADS", std::to_string(threads).c_str(), 1);
  setenv("GALLIUM_DRIVER", "llvmpipe", 1);
  setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
  try {
    start_egl();
    gl = {.load = eglGetProcAddress};
    if (description().find("llvmpipe") == std::string::npos)
      throw Error(Errc::no_device, "OpenGL: the driver is not llvmpipe but " + description());
    GLuint vertex_array = 0;
    gl.GenVertexArrays(1, &vertex_array);
    gl.BindVertexArray(vertex_array);
    gl.GenBuffers(2, buffers_);
    gl.ClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    gl.DepthFunc(GL_GREATER);
    gl.PixelStorei(GL_PACK_ALIGNMENT, 4);
    check("start");
  } catch (...) {
    stop_egl();
    throw;
  }
}

GlContext::~GlContext() {
  stop_egl();
}

void GlContext::start_egl() {
  display_ = eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
  if (display_ == EGL_NO_DISPLAY || eglInitialize(display_, nullptr, nullptr) == EGL_FALSE)
    throw Error(Errc::no_device,
                "OpenGL: EGL has no surfaceless platform here (Debian: libegl1 libgl1-mesa-dri)");
  const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION,
                               4,
                               EGL_CONTEXT_MINOR_VERSION,
                               5,
                               EGL_CONTEXT_OPENGL_PROFILE_MASK,
                               EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                               EGL_NONE};
  if (eglBindAPI(EGL_OPENGL_API) == EGL_FALSE ||
      (context_ = eglCreateContext(display_, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes)) ==
          EGL_NO_CONTEXT ||
      eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_) == EGL_FALSE)
    throw Error(Errc::no_device, "OpenGL: EGL gives no OpenGL 4.5 core context");
}

void GlContext::stop_egl() {
  if (display_ == EGL_NO_DISPLAY) return;
  eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  if (context_ != EGL_NO_CONTEXT) eglDestroyContext(display_, context_);
  eglTerminate(display_);
  display_ = EGL_NO_DISPLAY;
}

std::string GlContext::description() const {
  const auto text = [&](GLenum what) {
    return std::string(reinterpret_cast<const char*>(gl.GetString(what)));
  };
  return text(GL_VERSION) + ", " + text(GL_RENDERER);
}

void GlContext::check(const char* where) const {
  if (const GLenum e = gl.GetError(); e != GL_NO_ERROR)
    throw Error(e == GL_OUT_OF_MEMORY ? Errc::out_of_memory : Errc::unsupported,
                std::string("OpenGL error ") + std::to_string(e) + " in " + where);
}

GLint GlContext::limit(GLenum what) const {
  GLint value = 0;
  gl.GetIntegerv(what, &value);
  return value;
}

GLuint GlContext::shader(GLenum stage, const std::string& source) const {
  const GLuint name = gl.CreateShader(stage);
  const GLchar* text = source.c_str();
  gl.ShaderSource(name, 1, &text, nullptr);
  gl.CompileShader(name);
  GLint ok = 0;
  gl.GetShaderiv(name, GL_COMPILE_STATUS, &ok);
  if (ok == 0) {
    std::string log(4096, '\0');
    GLsizei length = 0;
    gl.GetShaderInfoLog(name, static_cast<GLsizei>(log.size()), &length, log.data());
    log.resize(static_cast<std::size_t>(length));
    throw Error(Errc::unsupported, "OpenGL refuses a shader: " + log);
  }
  return name;
}

GLuint GlContext::program(const std::string& vertex_source,
                          const std::string& fragment_source) const {
  const GLuint name = gl.CreateProgram();
  gl.AttachShader(name, shader(GL_VERTEX_SHADER, vertex_source));
  gl.AttachShader(name, shader(GL_FRAGMENT_SHADER, fragment_source));
  gl.LinkProgram(name);
  GLint ok = 0;
  gl.GetProgramiv(name, GL_LINK_STATUS, &ok);
  if (ok == 0) throw Error(Errc::unsupported, "OpenGL does not link the peer's program");
  return name;
}

GlProgram GlContext::mesh_program(const std::string& fragment_source,
                                  const std::string& more) const {
  GlProgram p;
  p.name = program(kVertexShader + more, fragment_source);
  p.rows = gl.GetUniformLocation(p.name, "rows");
  p.eye = gl.GetUniformLocation(p.name, "eye");
  return p;
}

void GlContext::set_mesh(const MeshView& mesh) {
  if (!mesh.normals.indices.empty())
    throw Error(Errc::invalid_argument,
                "the OpenGL peers' normals must share the positions' indices");
  const auto bytes = [](std::size_t n) { return static_cast<GLsizeiptr>(n); };
  const std::size_t positions = mesh.positions.packed().size_bytes();
  const std::size_t normals = mesh.normals.values.packed().size_bytes();
  gl.BindBuffer(GL_ARRAY_BUFFER, buffers_[0]);
  gl.BufferData(GL_ARRAY_BUFFER, bytes(positions * 2), nullptr, GL_STATIC_DRAW);
  gl.BufferSubData(GL_ARRAY_BUFFER, 0, bytes(positions), mesh.positions.data());
  if (normals != 0)
    gl.BufferSubData(GL_ARRAY_BUFFER, bytes(positions), bytes(normals), mesh.normals.values.data());
  std::vector<std::uint32_t> in_order;
  std::span<const std::uint32_t> indices = mesh.indices.packed();
  if (indices.empty()) {
    in_order.resize(mesh.positions.size() / 3 * 3);
    std::iota(in_order.begin(), in_order.end(), 0U);
    indices = in_order;
  }
  gl.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers_[1]);
  gl.BufferData(GL_ELEMENT_ARRAY_BUFFER, bytes(indices.size_bytes()), indices.data(),
                GL_STATIC_DRAW);
  index_count_ = static_cast<GLsizei>(indices.size());
  point_count_ = 0;
  gl.EnableVertexAttribArray(0);
  gl.VertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(Vec3), nullptr);
  gl.EnableVertexAttribArray(1);
  gl.VertexAttribPointer(1, 3, GL_FLOAT, GL_FALSE, sizeof(Vec3),
                         reinterpret_cast<const void*>(positions));
  check("set_mesh");
}

void GlContext::set_points(std::span<const Vec3> positions) {
  gl.BindBuffer(GL_ARRAY_BUFFER, buffers_[0]);
  gl.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(positions.size_bytes()), positions.data(),
                GL_STATIC_DRAW);
  gl.EnableVertexAttribArray(0);
  gl.VertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(Vec3), nullptr);
  gl.VertexAttribPointer(1, 3, GL_FLOAT, GL_FALSE, sizeof(Vec3), nullptr);
  point_count_ = static_cast<GLsizei>(positions.size());
  check("set_points");
}

bool GlContext::set_view(const Camera& camera, int width, int height) {
  world_to_clip_ = static_cast<Mat4>(rastrum::world_to_clip(camera, width, height));
  const Vec3 eye(camera.eye);
  const Vec3 viewer = camera.orthographic ? normalize(eye - Vec3(camera.target)) : eye;
  eye_ = {viewer.x, viewer.y, viewer.z, camera.orthographic ? 0.0F : 1.0F};
  if (width == width_ && height == height_) return false;
  const GLint largest = limit(GL_MAX_RENDERBUFFER_SIZE);
  if (width > largest || height > largest)
    throw Error(Errc::unsupported,
                "OpenGL: framebuffers end at " + std::to_string(largest) + " px");
  width_ = width;
  height_ = height;
  return true;
}

void GlContext::use(const GlProgram& p) const {
  gl.UseProgram(p.name);
  gl.Viewport(0, 0, width_, height_);
  gl.Uniform4fv(p.rows, 4, &world_to_clip_.m[0][0]);
  if (p.eye >= 0) gl.Uniform4fv(p.eye, 1, &eye_.x);
}

void GlContext::draw_mesh(const GlProgram& p) const {
  use(p);
  if (point_count_ != 0) return gl.DrawArrays(GL_POINTS, 0, point_count_);
  gl.DrawElements(GL_TRIANGLES, index_count_, GL_UNSIGNED_INT, nullptr);
}

void GlContext::finish_framebuffer() const {
  if (gl.CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    throw Error(Errc::unsupported, "OpenGL: no framebuffer of " + std::to_string(width_) + "x" +
                                       std::to_string(height_));
  gl.ReadBuffer(GL_COLOR_ATTACHMENT0);
  check("framebuffer");
}

void GlContext::clear_color() const {
  const GLfloat nothing[4] = {};
  gl.ClearBufferfv(GL_COLOR, 0, nothing);
}

void GlContext::clear_depth() const {
  const GLfloat far_depth = 0;
  gl.Enable(GL_DEPTH_TEST);
  gl.DepthMask(GL_TRUE);
  gl.ClearBufferfv(GL_DEPTH, 0, &far_depth);
}

}  // namespace rastrum::bench
