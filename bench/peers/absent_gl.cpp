// SPDX-License-Identifier: BSD-3-Clause
// Replaces the OpenGL peers in builds without them. Their constructors throw.
#include <rastrum/error.hpp>

#include "gl_materials.hpp"
#include "gl_peer.hpp"
#include "gl_transparency.hpp"

namespace rastrum::bench {
namespace {

[[noreturn]] void say_so() {
  throw Error(Errc::no_device,
              "OpenGL: this build has no EGL (Debian: libegl-dev libgl-dev libgl1-mesa-dri)");
}

}  // namespace

struct GlMaterials::Impl {};
struct GlPeer::Impl {};
struct GlTransparency::Impl {};

GlPeer::GlPeer(int) {
  say_so();
}
// No object exists, so these are never called.
GlPeer::~GlPeer() = default;
std::string GlPeer::description() const {
  return {};
}
void GlPeer::set_mesh(const MeshView&) {}
void GlPeer::set_points(std::span<const Vec3>) {}
void GlPeer::set_view(const Camera&, int, int) {}
void GlPeer::draw_phong() {}
void GlPeer::draw_ids() {}
Image<Rgba8> GlPeer::colors() {
  return {};
}
Image<std::int32_t> GlPeer::ids() {
  return {};
}
Image<float> GlPeer::depths() {
  return {};
}
Image<std::uint32_t> GlPeer::fragment_counts() {
  return {};
}
std::uint64_t GlPeer::samples_passed() {
  return 0;
}

GlMaterials::GlMaterials(int) {
  say_so();
}
GlMaterials::~GlMaterials() = default;
std::string GlMaterials::description() const {
  return {};
}
void GlMaterials::set_scene(const SceneView&) {}
void GlMaterials::set_view(const Camera&, int, int) {}
void GlMaterials::draw() {}
Image<Rgba8> GlMaterials::colors() {
  return {};
}

GlTransparency::GlTransparency(int) {
  say_so();
}
GlTransparency::~GlTransparency() = default;
std::string GlTransparency::description() const {
  return {};
}
void GlTransparency::set_mesh(const MeshView&) {}
void GlTransparency::set_view(const Camera&, int, int) {}
std::uint64_t GlTransparency::fragments() const {
  return 0;
}
GlTransparency::Frame GlTransparency::draw(GlBlending, float, GlPrecision, double) {
  return {};
}
Image<Vec4> GlTransparency::picture() {
  return {};
}

}  // namespace rastrum::bench
