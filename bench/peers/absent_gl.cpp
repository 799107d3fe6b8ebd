// Stands where the OpenGL peer was not built: its constructor says so.
#include "gl_peer.hpp"

#include <rastrum/core/error.hpp>

namespace rastrum::bench {

struct GlPeer::Impl {};

GlPeer::GlPeer(int) {
  throw Error(Errc::no_device,
              "OpenGL: this build has no EGL (Debian: libegl-dev libgl-dev libgl1-mesa-dri)");
}
// No object exists, so nothing below is ever called.
GlPeer::~GlPeer() = default;
std::string GlPeer::description() const {
  return {};
}
void GlPeer::set_mesh(const MeshView&) {}
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

}  // namespace rastrum::bench
