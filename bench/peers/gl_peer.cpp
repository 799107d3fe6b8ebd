// The OpenGL peer; see the header. The vertex shader multiplies the matrix in the written order of
// transform_point, so that clip coordinates are those of Rastrum, and turns y over, so that row 0
// is the top. glClipControl(GL_UPPER_LEFT) would do that too, but Mesa 22.3 then gives samples on
// horizontal edges to the triangle above (the bottom-left rule), found by drawing such triangles.
#include "gl_peer.hpp"

#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <cstdlib>
#include <numeric>
#include <string_view>
#include <vector>

#include "gl_api.hpp"

namespace rastrum::bench {
namespace {

constexpr const char* kVertexShader = R"(#version 450 core
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
uniform vec4 rows[4];
uniform vec4 eye;
out vec3 n;
out vec3 v;
void main() {
  precise vec4 clip;
  clip.x = ((rows[0].x * position.x + rows[0].y * position.y) + rows[0].z * position.z) + rows[0].w;
  clip.y = ((rows[1].x * position.x + rows[1].y * position.y) + rows[1].z * position.z) + rows[1].w;
  clip.z = ((rows[2].x * position.x + rows[2].y * position.y) + rows[2].z * position.z) + rows[2].w;
  clip.w = ((rows[3].x * position.x + rows[3].y * position.y) + rows[3].z * position.z) + rows[3].w;
  gl_Position = vec4(clip.x, -clip.y, clip.z, clip.w);
  n = normal;
  v = eye.xyz - eye.w * position;
})";

// v is the way to the viewer: eye − position, or one direction for an orthographic camera (eye.w =
// 0).
constexpr const char* kPhongShader = R"(#version 450 core
in vec3 n;
in vec3 v;
layout(location = 0) out vec4 color;
void main() {
  vec3 to_eye = normalize(v);
  vec3 normal = normalize(n);
  if (dot(normal, to_eye) < 0.0) normal = -normal;
  vec3 light = normalize(vec3(0.4, 0.6, 1.0));
  vec3 halfway = normalize(light + to_eye);
  float diffuse = 0.1 + 0.8 * max(dot(normal, light), 0.0);
  float highlight = 0.3 * pow(max(dot(normal, halfway), 0.0), 32.0);
  color = vec4(vec3(0.8, 0.7, 0.6) * diffuse + highlight, 1.0);
})";

constexpr const char* kIdShader = R"(#version 450 core
layout(location = 0) out int id;
void main() { id = gl_PrimitiveID; })";

constexpr const char* kCountShader = R"(#version 450 core
layout(location = 0) out float count;
void main() { count = 1.0; })";

/// A framebuffer object: one colour format, and depth.
struct Target {
  GLuint framebuffer = 0, color = 0, depth = 0;
};

struct Program {
  GLuint name = 0;
  GLint rows = -1, eye = -1;
};

}  // namespace

struct GlPeer::Impl {
  EGLDisplay display = EGL_NO_DISPLAY;
  EGLContext context = EGL_NO_CONTEXT;
  GlApi gl;
  Program phong, id, count;
  GLuint buffers[2] = {};  // vertices, indices
  GLsizei index_count = 0;
  int width = 0, height = 0;
  Mat4 world_to_clip{};
  Vec4 eye{};
  Target phong_target, id_target, count_target;
  const Target* last_target = nullptr;
  GLuint query = 0;

  explicit Impl(int threads) {
    setenv("LP_NUM_THREADS", std::to_string(threads).c_str(), 1);
    setenv("GALLIUM_DRIVER", "llvmpipe", 1);
    setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
    try {
      start_egl();
      gl = GlApi::load(eglGetProcAddress);
      start_gl();
    } catch (...) {
      stop_egl();
      throw;
    }
  }
  ~Impl() { stop_egl(); }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  void start_egl() {
    display = eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    if (display == EGL_NO_DISPLAY || eglInitialize(display, nullptr, nullptr) == EGL_FALSE)
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
        (context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes)) ==
            EGL_NO_CONTEXT ||
        eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context) == EGL_FALSE)
      throw Error(Errc::no_device, "OpenGL: EGL gives no OpenGL 4.5 core context");
  }

  void stop_egl() {
    if (display == EGL_NO_DISPLAY) return;
    eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    if (context != EGL_NO_CONTEXT) eglDestroyContext(display, context);
    eglTerminate(display);
    display = EGL_NO_DISPLAY;
  }

  void start_gl() {
    if (description().find("llvmpipe") == std::string::npos)
      throw Error(Errc::no_device, "OpenGL: the driver is not llvmpipe but " + description());
    phong = program(kPhongShader);
    id = program(kIdShader);
    count = program(kCountShader);
    GLuint vertex_array = 0;
    gl.GenVertexArrays(1, &vertex_array);
    gl.BindVertexArray(vertex_array);
    gl.GenBuffers(2, buffers);
    gl.GenQueries(1, &query);
    gl.ClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    gl.DepthFunc(GL_GREATER);
    gl.BlendFunc(GL_ONE, GL_ONE);
    gl.PixelStorei(GL_PACK_ALIGNMENT, 4);
    check("start");
  }

  [[nodiscard]] std::string description() const {
    const auto text = [&](GLenum what) {
      return std::string(reinterpret_cast<const char*>(gl.GetString(what)));
    };
    return text(GL_VERSION) + ", " + text(GL_RENDERER);
  }

  void check(const char* where) const {
    if (const GLenum e = gl.GetError(); e != GL_NO_ERROR)
      throw Error(e == GL_OUT_OF_MEMORY ? Errc::out_of_memory : Errc::unsupported,
                  std::string("OpenGL error ") + std::to_string(e) + " in " + where);
  }

  GLuint shader(GLenum stage, const char* source) {
    const GLuint name = gl.CreateShader(stage);
    gl.ShaderSource(name, 1, &source, nullptr);
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

  Program program(const char* fragment_source) {
    Program p;
    p.name = gl.CreateProgram();
    gl.AttachShader(p.name, shader(GL_VERTEX_SHADER, kVertexShader));
    gl.AttachShader(p.name, shader(GL_FRAGMENT_SHADER, fragment_source));
    gl.LinkProgram(p.name);
    GLint ok = 0;
    gl.GetProgramiv(p.name, GL_LINK_STATUS, &ok);
    if (ok == 0) throw Error(Errc::unsupported, "OpenGL does not link the peer's program");
    p.rows = gl.GetUniformLocation(p.name, "rows");
    p.eye = gl.GetUniformLocation(p.name, "eye");
    return p;
  }

  void set_mesh(const MeshView& mesh) {
    if (!mesh.normals.indices.empty())
      throw Error(Errc::invalid_argument, "GlPeer: normals must share the positions' indices");
    const auto bytes = [](std::size_t n) { return static_cast<GLsizeiptr>(n); };
    const std::size_t positions = mesh.positions.size_bytes();
    const std::size_t normals = mesh.normals.values.size_bytes();
    gl.BindBuffer(GL_ARRAY_BUFFER, buffers[0]);
    gl.BufferData(GL_ARRAY_BUFFER, bytes(positions * 2), nullptr, GL_STATIC_DRAW);
    gl.BufferSubData(GL_ARRAY_BUFFER, 0, bytes(positions), mesh.positions.data());
    if (normals != 0)
      gl.BufferSubData(GL_ARRAY_BUFFER, bytes(positions), bytes(normals),
                       mesh.normals.values.data());
    std::vector<std::uint32_t> in_order;
    std::span<const std::uint32_t> indices = mesh.indices;
    if (indices.empty()) {
      in_order.resize(mesh.positions.size() / 3 * 3);
      std::iota(in_order.begin(), in_order.end(), 0U);
      indices = in_order;
    }
    gl.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers[1]);
    gl.BufferData(GL_ELEMENT_ARRAY_BUFFER, bytes(indices.size_bytes()), indices.data(),
                  GL_STATIC_DRAW);
    index_count = static_cast<GLsizei>(indices.size());
    gl.EnableVertexAttribArray(0);
    gl.VertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(Vec3), nullptr);
    gl.EnableVertexAttribArray(1);
    gl.VertexAttribPointer(1, 3, GL_FLOAT, GL_FALSE, sizeof(Vec3),
                           reinterpret_cast<const void*>(positions));
    check("set_mesh");
  }

  void release(Target& target) {
    gl.DeleteFramebuffers(1, &target.framebuffer);
    gl.DeleteRenderbuffers(1, &target.color);
    gl.DeleteRenderbuffers(1, &target.depth);
    target = {};
  }

  /// Binds `target`, made at its first use after a change of size.
  void bind(Target& target, GLenum format) {
    last_target = &target;
    if (target.framebuffer != 0) {
      gl.BindFramebuffer(GL_FRAMEBUFFER, target.framebuffer);
      return;
    }
    gl.GenFramebuffers(1, &target.framebuffer);
    gl.BindFramebuffer(GL_FRAMEBUFFER, target.framebuffer);
    const auto attach = [&](GLuint& buffer, GLenum internal, GLenum where) {
      gl.GenRenderbuffers(1, &buffer);
      gl.BindRenderbuffer(GL_RENDERBUFFER, buffer);
      gl.RenderbufferStorage(GL_RENDERBUFFER, internal, width, height);
      gl.FramebufferRenderbuffer(GL_FRAMEBUFFER, where, GL_RENDERBUFFER, buffer);
    };
    attach(target.color, format, GL_COLOR_ATTACHMENT0);
    attach(target.depth, GL_DEPTH_COMPONENT32F, GL_DEPTH_ATTACHMENT);
    if (gl.CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
      throw Error(Errc::unsupported, "OpenGL: no framebuffer of " + std::to_string(width) + "x" +
                                         std::to_string(height));
    gl.ReadBuffer(GL_COLOR_ATTACHMENT0);
    check("framebuffer");
  }

  void draw(const Program& p) {
    gl.UseProgram(p.name);
    gl.Viewport(0, 0, width, height);
    gl.Uniform4fv(p.rows, 4, &world_to_clip.m[0][0]);
    if (p.eye >= 0) gl.Uniform4fv(p.eye, 1, &eye.x);
    gl.DrawElements(GL_TRIANGLES, index_count, GL_UNSIGNED_INT, nullptr);
  }

  void clear_depth() {
    const GLfloat far_depth = 0;
    gl.Enable(GL_DEPTH_TEST);
    gl.DepthMask(GL_TRUE);
    gl.ClearBufferfv(GL_DEPTH, 0, &far_depth);
  }

  template <class T>
  Image<T> read(const Target& target, GLenum format, GLenum type) {
    if (last_target != &target)
      throw Error(Errc::invalid_argument, "GlPeer: the last draw made no such image");
    Image<T> image(width, height);
    gl.ReadPixels(0, 0, width, height, format, type, image.pixels().data());
    check("read");
    return image;
  }

  void begin_count() {
    bind(count_target, GL_R32F);
    const GLfloat zero[4] = {};
    gl.Disable(GL_DEPTH_TEST);
    gl.ClearBufferfv(GL_COLOR, 0, zero);
    gl.Enable(GL_BLEND);
  }
};

GlPeer::GlPeer(int threads) : impl_(std::make_unique<Impl>(threads)) {}
GlPeer::~GlPeer() = default;

std::string GlPeer::description() const {
  return impl_->description();
}

void GlPeer::set_mesh(const MeshView& mesh) {
  impl_->set_mesh(mesh);
}

void GlPeer::set_view(const Camera& camera, int width, int height) {
  Impl& s = *impl_;
  s.world_to_clip = static_cast<Mat4>(rastrum::world_to_clip(camera, width, height));
  const Vec3 viewer = camera.orthographic ? normalize(camera.eye - camera.target) : camera.eye;
  s.eye = {viewer.x, viewer.y, viewer.z, camera.orthographic ? 0.0F : 1.0F};
  if (width == s.width && height == s.height) return;
  GLint largest = 0;
  s.gl.GetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &largest);
  if (width > largest || height > largest)
    throw Error(Errc::unsupported,
                "OpenGL: framebuffers end at " + std::to_string(largest) + " px");
  for (Target* t : {&s.phong_target, &s.id_target, &s.count_target}) s.release(*t);
  s.last_target = nullptr;
  s.width = width;
  s.height = height;
}

void GlPeer::draw_phong() {
  Impl& s = *impl_;
  s.bind(s.phong_target, GL_RGBA8);
  const GLfloat background[4] = {};
  s.gl.ClearBufferfv(GL_COLOR, 0, background);
  s.clear_depth();
  s.draw(s.phong);
  s.gl.Finish();
}

void GlPeer::draw_ids() {
  Impl& s = *impl_;
  s.bind(s.id_target, GL_R32I);
  const GLint nothing[4] = {-1, -1, -1, -1};
  s.gl.ClearBufferiv(GL_COLOR, 0, nothing);
  s.clear_depth();
  s.draw(s.id);
  s.gl.Finish();
}

Image<Rgba8> GlPeer::colors() {
  return impl_->read<Rgba8>(impl_->phong_target, GL_RGBA, GL_UNSIGNED_BYTE);
}

Image<std::int32_t> GlPeer::ids() {
  return impl_->read<std::int32_t>(impl_->id_target, GL_RED_INTEGER, GL_INT);
}

Image<float> GlPeer::depths() {
  if (impl_->last_target == nullptr)
    throw Error(Errc::invalid_argument, "GlPeer: nothing has been drawn at this size");
  return impl_->read<float>(*impl_->last_target, GL_DEPTH_COMPONENT, GL_FLOAT);
}

Image<std::uint32_t> GlPeer::fragment_counts() {
  Impl& s = *impl_;
  s.begin_count();
  s.draw(s.count);
  s.gl.Disable(GL_BLEND);
  const Image<float> sums = s.read<float>(s.count_target, GL_RED, GL_FLOAT);
  Image<std::uint32_t> counts(s.width, s.height);
  for (std::size_t i = 0; i < counts.pixels().size(); ++i)
    counts.pixels()[i] = static_cast<std::uint32_t>(sums.pixels()[i]);
  return counts;
}

std::uint64_t GlPeer::samples_passed() {
  Impl& s = *impl_;
  s.begin_count();
  s.gl.BeginQuery(GL_SAMPLES_PASSED, s.query);
  s.draw(s.count);
  s.gl.EndQuery(GL_SAMPLES_PASSED);
  s.gl.Disable(GL_BLEND);
  GLuint64 samples = 0;
  s.gl.GetQueryObjectui64v(s.query, GL_QUERY_RESULT, &samples);
  s.check("samples_passed");
  return samples;
}

}  // namespace rastrum::bench
