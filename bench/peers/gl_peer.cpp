// SPDX-License-Identifier: BSD-3-Clause
#include "gl_peer.hpp"

#include "gl_context.hpp"
#include "gl_target.hpp"

namespace rastrum::bench {
namespace {

constexpr const char* kPhongMain = R"(
layout(location = 0) out vec4 color;
void main() { color = vec4(phong(), 1.0); })";

constexpr const char* kIdShader = R"(#version 450 core
layout(location = 0) out int id;
void main() { id = gl_PrimitiveID; })";

constexpr const char* kCountShader = R"(#version 450 core
layout(location = 0) out float count;
void main() { count = 1.0; })";

}  // namespace

struct GlPeer::Impl {
  GlContext context;
  const GlApi& gl = context.gl;
  GlProgram phong, id, count;
  GlTarget phong_target{GL_RGBA8}, id_target{GL_R32I}, count_target{GL_R32F};
  const GlTarget* last_target = nullptr;
  GLuint query = 0;

  explicit Impl(int threads)
      : context(threads),
        phong(context.mesh_program(std::string(kGlslPhong) + kPhongMain)),
        id(context.mesh_program(kIdShader)),
        count(context.mesh_program(kCountShader)) {
    gl.GenQueries(1, &query);
    gl.BlendFunc(GL_ONE, GL_ONE);
    context.check("start");
  }

  void bind(GlTarget& target) {
    last_target = &target;
    target.bind(context);
  }

  template <class T>
  Image<T> read(const GlTarget& target, GLenum format, GLenum type) {
    if (last_target != &target)
      throw Error(Errc::invalid_argument, "GlPeer: the last draw made no such image");
    return context.read<T>(format, type, "read");
  }

  void begin_count() {
    bind(count_target);
    gl.Disable(GL_DEPTH_TEST);
    context.clear_color();
    gl.Enable(GL_BLEND);
  }
};

GlPeer::GlPeer(int threads) : impl_(std::make_unique<Impl>(threads)) {}
GlPeer::~GlPeer() = default;

std::string GlPeer::description() const {
  return impl_->context.description();
}

void GlPeer::set_mesh(const MeshView& mesh) {
  impl_->context.set_mesh(mesh);
}

void GlPeer::set_points(std::span<const Vec3> positions) {
  impl_->context.set_points(positions);
}

void GlPeer::set_view(const Camera& camera, int width, int height) {
  Impl& s = *impl_;
  if (!s.context.set_view(camera, width, height)) return;
  for (GlTarget* t : {&s.phong_target, &s.id_target, &s.count_target}) t->release(s.context);
  s.last_target = nullptr;
}

void GlPeer::draw_phong() {
  Impl& s = *impl_;
  s.bind(s.phong_target);
  s.context.clear_color();
  s.context.clear_depth();
  s.context.draw_mesh(s.phong);
  s.gl.Finish();
}

void GlPeer::draw_ids() {
  Impl& s = *impl_;
  s.bind(s.id_target);
  const GLint nothing[4] = {-1, -1, -1, -1};
  s.gl.ClearBufferiv(GL_COLOR, 0, nothing);
  s.context.clear_depth();
  s.context.draw_mesh(s.id);
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
  s.context.draw_mesh(s.count);
  s.gl.Disable(GL_BLEND);
  const Image<float> sums = s.read<float>(s.count_target, GL_RED, GL_FLOAT);
  Image<std::uint32_t> counts(sums.width(), sums.height());
  for (std::size_t i = 0; i < counts.pixels().size(); ++i)
    counts.pixels()[i] = static_cast<std::uint32_t>(sums.pixels()[i]);
  return counts;
}

std::uint64_t GlPeer::samples_passed() {
  Impl& s = *impl_;
  s.begin_count();
  s.gl.BeginQuery(GL_SAMPLES_PASSED, s.query);
  s.context.draw_mesh(s.count);
  s.gl.EndQuery(GL_SAMPLES_PASSED);
  s.gl.Disable(GL_BLEND);
  GLuint64 samples = 0;
  s.gl.GetQueryObjectui64v(s.query, GL_QUERY_RESULT, &samples);
  s.context.check("samples_passed");
  return samples;
}

}  // namespace rastrum::bench
