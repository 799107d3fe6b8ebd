// SPDX-License-Identifier: BSD-3-Clause
#include "gl_transparency.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <string>
#include <vector>

#include "gl_context.hpp"

namespace rastrum::bench {
namespace {

/// Nodes of one buffer, a power of two: 128 MiB, the most that llvmpipe binds.
constexpr std::uint64_t kNodesPerBuffer = 1U << 23;
constexpr int kHeads = 0, kFirstNodes = 1;  ///< bindings of storage buffers

constexpr const char* kBlendMain = R"(
uniform float opacity;
layout(location = 0) out vec4 color;
void main() { color = vec4(phong() * opacity, opacity); })";

constexpr const char* kNothing = R"(#version 450 core
void main() {})";

/// Discards fragments that are at or in front of what the last pass peeled.
constexpr const char* kPeelMain = R"(
uniform float opacity;
uniform bool first;
layout(binding = 0) uniform sampler2D peeled;
layout(location = 0) out vec4 color;
void main() {
  if (!first && gl_FragCoord.z >= texelFetch(peeled, ivec2(gl_FragCoord.xy), 0).r) discard;
  color = vec4(phong() * opacity, opacity);
})";

constexpr const char* kWholeScreen = R"(#version 450 core
void main() {
  gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.5, 1.0);
})";

constexpr const char* kCopy = R"(#version 450 core
layout(binding = 0) uniform sampler2D layer;
layout(location = 0) out vec4 color;
void main() { color = texelFetch(layer, ivec2(gl_FragCoord.xy), 0); })";

/// Declares the heads and as many node buffers as needed; node 0 is the end. llvmpipe executes both
/// sides of a branch, so unneeded buffers must not be in the code.
std::string list_storage(int buffers) {
  const auto each = [&](auto&& text) {
    std::string all;
    for (int i = 0; i < buffers; ++i) all += text(std::to_string(i));
    return all;
  };
  const std::string choice = "  switch (k / " + std::to_string(kNodesPerBuffer) + "u) {\n";
  const std::string place = "[k % " + std::to_string(kNodesPerBuffer) + "u]";
  std::string text = R"(
struct Node { uvec2 rgba; float depth; uint next; };
layout(std430, binding = 0) buffer Heads { uint used; uint head[]; };
)";
  text += each([](const std::string& i) {
    return "layout(std430, binding = " + std::to_string(kFirstNodes + std::stoi(i)) +
           ") buffer Nodes" + i + " { Node nodes" + i + "[]; };\n";
  });
  text += "void store(uint k, Node n) {\n" + choice;
  text += each([&](const std::string& i) {
    return "    case " + i + "u: nodes" + i + place + " = n; break;\n";
  });
  text += "  }\n}\nNode load(uint k) {\n" + choice;
  text += each([&](const std::string& i) {
    return "    case " + i + "u: return nodes" + i + place + ";\n";
  });
  return text + "  }\n  return nodes0[0];\n}\n";
}

constexpr const char* kListMain = R"(
uniform float opacity;
uniform int width;
void main() {
  vec3 color = phong() * opacity;
  uint k = atomicAdd(used, 1u);
  uint pixel = uint(gl_FragCoord.y) * uint(width) + uint(gl_FragCoord.x);
  uint next = atomicExchange(head[pixel], k + 1u);
  store(k, Node(uvec2(packHalf2x16(color.rg), packHalf2x16(vec2(color.b, opacity))),
                gl_FragCoord.z, next));
})";

/// Sorts the 64 nearest unblended fragments by insertion and blends them, until none is left. So
/// lists may have any length. Later nodes of a list were submitted earlier and are in front at
/// equal depth.
constexpr const char* kResolveMain = R"(
uniform int width;
layout(location = 0) out vec4 color;
const int K = 64;
void main() {
  uint first = head[uint(gl_FragCoord.y) * uint(width) + uint(gl_FragCoord.x)];
  vec4 sum = vec4(0.0);
  float depths[K];
  uint numbers[K];
  uint places[K];
  float below = 2.0;
  uint below_place = 0u;
  int held = first == 0u ? 0 : K;
  while (held == K) {
    held = 0;
    uint place = 0u;
    for (uint k = first; k != 0u;) {
      Node n = load(k - 1u);
      ++place;
      bool open = n.depth < below || (n.depth == below && place < below_place);
      if (open && (held < K || n.depth >= depths[K - 1])) {
        int i = min(held, K - 1);
        for (; i > 0 && depths[i - 1] <= n.depth; --i) {
          depths[i] = depths[i - 1];
          numbers[i] = numbers[i - 1];
          places[i] = places[i - 1];
        }
        depths[i] = n.depth;
        numbers[i] = k;
        places[i] = place;
        held = min(held + 1, K);
      }
      k = n.next;
    }
    for (int i = 0; i < held; ++i) {
      uvec2 rgba = load(numbers[i] - 1u).rgba;
      sum += (1.0 - sum.a) * vec4(unpackHalf2x16(rgba.x), unpackHalf2x16(rgba.y));
    }
    if (held == K) {
      below = depths[K - 1];
      below_place = places[K - 1];
    }
  }
  color = sum;
})";

/// Colour, and perhaps depth, as textures of the view's size.
struct Surface {
  GLuint framebuffer = 0, color = 0, depth = 0;
};

}  // namespace

struct GlTransparency::Impl {
  GlContext context;
  const GlApi& gl = context.gl;
  GlProgram blend, peel, count, list{};
  GLuint copy, resolve = 0;
  GLuint query = 0;
  std::uint64_t fragments = 0;
  /// Targets by precision, made at their first use. The passes alternate between two `layers`.
  std::array<Surface, 2> pictures{};
  std::array<std::array<Surface, 2>, 2> layers{};
  const Surface* last = nullptr;
  GLuint heads = 0;
  std::vector<GLuint> nodes;
  int list_buffers = 0;  ///< the number that `list` and `resolve` were compiled for

  explicit Impl(int threads)
      : context(threads),
        blend(context.mesh_program(std::string(kGlslPhong) + kBlendMain)),
        peel(context.mesh_program(std::string(kGlslPhong) + kPeelMain)),
        count(context.mesh_program(kNothing)),
        copy(context.program(kWholeScreen, kCopy)) {
    gl.GenQueries(1, &query);
    gl.Disable(GL_DEPTH_TEST);
    context.check("start");
  }

  void release_surfaces() {
    const auto release = [&](Surface& s) {
      gl.DeleteFramebuffers(1, &s.framebuffer);
      gl.DeleteTextures(1, &s.color);
      gl.DeleteTextures(1, &s.depth);
      s = {};
    };
    for (Surface& s : pictures) release(s);
    for (auto& pair : layers)
      for (Surface& s : pair) release(s);
    last = nullptr;
  }

  void release_lists() {
    gl.DeleteBuffers(1, &heads);
    gl.DeleteBuffers(static_cast<GLsizei>(nodes.size()), nodes.data());
    heads = 0;
    nodes.clear();
  }

  void bind(Surface& s, GlPrecision precision, bool with_depth) {
    if (s.framebuffer != 0) {
      gl.BindFramebuffer(GL_FRAMEBUFFER, s.framebuffer);
      return;
    }
    gl.GenFramebuffers(1, &s.framebuffer);
    gl.BindFramebuffer(GL_FRAMEBUFFER, s.framebuffer);
    const auto attach = [&](GLuint& texture, GLenum format, GLenum where) {
      gl.GenTextures(1, &texture);
      gl.BindTexture(GL_TEXTURE_2D, texture);
      gl.TexStorage2D(GL_TEXTURE_2D, 1, format, context.width(), context.height());
      gl.FramebufferTexture2D(GL_FRAMEBUFFER, where, GL_TEXTURE_2D, texture, 0);
    };
    attach(s.color, precision == GlPrecision::rgba8 ? GL_RGBA8 : GL_RGBA32F, GL_COLOR_ATTACHMENT0);
    if (with_depth) attach(s.depth, GL_DEPTH_COMPONENT32F, GL_DEPTH_ATTACHMENT);
    context.finish_framebuffer();
  }

  void draw_mesh(const GlProgram& program, float opacity) const {
    gl.UseProgram(program.name);
    gl.Uniform1f(gl.GetUniformLocation(program.name, "opacity"), opacity);
    context.draw_mesh(program);
  }

  void draw_screen(GLuint program) const {
    gl.UseProgram(program);
    gl.DrawArrays(GL_TRIANGLES, 0, 3);
  }

  /// Returns the number of samples that pass in f.
  template <class F>
  std::uint64_t counted(F&& f) const {
    gl.BeginQuery(GL_SAMPLES_PASSED, query);
    f();
    gl.EndQuery(GL_SAMPLES_PASSED);
    GLuint64 samples = 0;
    gl.GetQueryObjectui64v(query, GL_QUERY_RESULT, &samples);
    return samples;
  }

  Surface& picture(GlPrecision precision) {
    Surface& s = pictures[static_cast<std::size_t>(precision)];
    bind(s, precision, false);
    last = &s;
    return s;
  }

  Frame draw_unsorted(float opacity, GlPrecision precision) {
    picture(precision);
    context.clear_color();
    gl.Enable(GL_BLEND);
    gl.BlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    draw_mesh(blend, opacity);
    gl.Disable(GL_BLEND);
    gl.Finish();
    return {};
  }

  /// Makes the buffers and programs for the view's fragments.
  void prepare_lists() {
    if (heads != 0) return;
    const std::uint64_t wanted = (fragments + kNodesPerBuffer - 1) / kNodesPerBuffer;
    const auto most =
        static_cast<std::uint64_t>(context.limit(GL_MAX_FRAGMENT_SHADER_STORAGE_BLOCKS)) - 1;
    if (wanted > std::min<std::uint64_t>(most, 14))
      throw Error(Errc::out_of_memory, "OpenGL: " + std::to_string(fragments) +
                                           " fragments are more than its lists can hold");
    const auto allocate = [&](std::uint64_t bytes) {
      GLuint buffer = 0;
      gl.GenBuffers(1, &buffer);
      gl.BindBuffer(GL_SHADER_STORAGE_BUFFER, buffer);
      gl.BufferData(GL_SHADER_STORAGE_BUFFER, static_cast<GLsizeiptr>(bytes), nullptr,
                    GL_DYNAMIC_COPY);
      return buffer;
    };
    const auto pixels =
        static_cast<std::uint64_t>(context.width()) * static_cast<std::uint64_t>(context.height());
    heads = allocate(4 * (1 + pixels));
    for (std::uint64_t first = 0; first < std::max<std::uint64_t>(fragments, 1);
         first += kNodesPerBuffer)
      nodes.push_back(allocate(
          kNodeBytes * std::min(kNodesPerBuffer, std::max<std::uint64_t>(fragments, 1) - first)));
    context.check("lists");
    if (list_buffers == static_cast<int>(nodes.size())) return;
    gl.DeleteProgram(list.name);
    gl.DeleteProgram(resolve);
    list_buffers = static_cast<int>(nodes.size());
    const std::string storage = list_storage(list_buffers);
    list = context.mesh_program(std::string(kGlslPhong) + storage + kListMain);
    resolve = context.program(kWholeScreen, "#version 450 core\n" + storage + kResolveMain);
  }

  Frame draw_lists(float opacity, GlPrecision precision) {
    prepare_lists();
    picture(precision);
    gl.BindBufferBase(GL_SHADER_STORAGE_BUFFER, kHeads, heads);
    for (std::size_t i = 0; i < nodes.size(); ++i)
      gl.BindBufferBase(GL_SHADER_STORAGE_BUFFER, static_cast<GLuint>(kFirstNodes + i), nodes[i]);
    const GLuint zero = 0;
    gl.BindBuffer(GL_SHADER_STORAGE_BUFFER, heads);
    gl.ClearBufferData(GL_SHADER_STORAGE_BUFFER, GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, &zero);
    gl.MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    for (const GLuint program : {list.name, resolve}) {
      gl.UseProgram(program);
      gl.Uniform1i(gl.GetUniformLocation(program, "width"), context.width());
    }
    gl.ColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    draw_mesh(list, opacity);
    gl.ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    gl.MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    draw_screen(resolve);
    gl.Finish();
    return {};
  }

  Frame draw_peeled(float opacity, GlPrecision precision, double patience_ms) {
    using Clock = std::chrono::steady_clock;
    const auto begin = Clock::now();
    auto& pair = layers[static_cast<std::size_t>(precision)];
    picture(precision);
    context.clear_color();
    gl.ActiveTexture(GL_TEXTURE0);
    Frame frame{0, false};
    while (!frame.complete) {
      const auto turn = static_cast<std::size_t>(frame.passes % 2);
      const GLfloat far_depth = 0;
      bind(pair[turn], precision, true);
      gl.Enable(GL_DEPTH_TEST);
      context.clear_color();
      gl.ClearBufferfv(GL_DEPTH, 0, &far_depth);
      gl.BindTexture(GL_TEXTURE_2D, frame.passes > 0 ? pair[1 - turn].depth : 0);
      gl.UseProgram(peel.name);
      gl.Uniform1i(gl.GetUniformLocation(peel.name, "first"), frame.passes == 0 ? 1 : 0);
      frame.complete = counted([&] { draw_mesh(peel, opacity); }) == 0;
      ++frame.passes;
      gl.Disable(GL_DEPTH_TEST);
      if (!frame.complete) {
        picture(precision);
        gl.BindTexture(GL_TEXTURE_2D, pair[turn].color);
        gl.Enable(GL_BLEND);
        gl.BlendFunc(GL_ONE_MINUS_DST_ALPHA, GL_ONE);
        draw_screen(copy);
        gl.Disable(GL_BLEND);
      }
      if (std::chrono::duration<double, std::milli>(Clock::now() - begin).count() > patience_ms)
        break;
    }
    gl.Finish();
    return frame;
  }
};

GlTransparency::GlTransparency(int threads) : impl_(std::make_unique<Impl>(threads)) {}
GlTransparency::~GlTransparency() = default;

std::string GlTransparency::description() const {
  return impl_->context.description();
}

void GlTransparency::set_mesh(const MeshView& mesh) {
  impl_->context.set_mesh(mesh);
}

void GlTransparency::set_view(const Camera& camera, int width, int height) {
  Impl& s = *impl_;
  if (s.context.set_view(camera, width, height)) s.release_surfaces();
  s.release_lists();
  s.picture(GlPrecision::rgba8);
  s.fragments = s.counted([&] { s.context.draw_mesh(s.count); });
  s.context.check("set_view");
}

std::uint64_t GlTransparency::fragments() const {
  return impl_->fragments;
}

GlTransparency::Frame GlTransparency::draw(GlBlending method, float opacity, GlPrecision precision,
                                           double patience_ms) {
  Impl& s = *impl_;
  const Frame frame = method == GlBlending::unsorted ? s.draw_unsorted(opacity, precision)
                      : method == GlBlending::lists
                          ? s.draw_lists(opacity, precision)
                          : s.draw_peeled(opacity, precision, patience_ms);
  s.context.check("draw");
  return frame;
}

Image<Vec4> GlTransparency::picture() {
  Impl& s = *impl_;
  if (s.last == nullptr)
    throw Error(Errc::invalid_argument, "GlTransparency: nothing has been drawn at this size");
  s.gl.BindFramebuffer(GL_FRAMEBUFFER, s.last->framebuffer);
  return s.context.read<Vec4>(GL_RGBA, GL_FLOAT, "picture");
}

}  // namespace rastrum::bench
