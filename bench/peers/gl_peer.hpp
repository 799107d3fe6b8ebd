// SPDX-License-Identifier: BSD-3-Clause
// OpenGL without a window, on Mesa's llvmpipe: the peer whose pictures and frame times ours are
// compared with. EGL's surfaceless platform, core profile, one framebuffer object with RGBA8 colour
// and 32-bit float depth, static buffers.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include <rastrum/camera.hpp>
#include <rastrum/image.hpp>
#include <rastrum/mat.hpp>
#include <rastrum/mesh.hpp>

namespace rastrum::bench {

/// Draws one mesh at a time by the conventions of `docs/conventions.md`: row 0 at the top, the
/// top-left rule, reversed depth in [0, 1], the first submitted triangle wins equal depths. Only
/// one at a time in a process; bound to the thread that made it.
class GlPeer {
 public:
  /// Starts llvmpipe like GlContext. Throws Error{no_device}, which says what is missing.
  explicit GlPeer(int threads = 2);
  ~GlPeer();
  GlPeer(const GlPeer&) = delete;
  GlPeer& operator=(const GlPeer&) = delete;

  /// GL_VERSION and GL_RENDERER.
  [[nodiscard]] std::string description() const;

  /// Copies positions, indices and normals into static buffers. Throws Error{invalid_argument}
  /// unless the normals share the positions' indices.
  void set_mesh(const MeshView& mesh);
  /// Takes points of one pixel instead of a mesh. `draw_ids` draws their ids.
  void set_points(std::span<const Vec3> positions);
  /// Takes `world_to_clip(camera, width, height)`, rounded to float32, and makes a framebuffer of
  /// that size. Throws Error{unsupported} if the driver has none that large.
  void set_view(const Camera& camera, int width, int height);

  /// Clears, draws with `phong`, base (0.8, 0.7, 0.6), and waits for the end (glFinish).
  void draw_phong();
  /// Clears and draws triangle numbers with the depth test, −1 for nothing; waits for the end.
  void draw_ids();
  /// The colours of the last `draw_phong`.
  [[nodiscard]] Image<Rgba8> colors();
  /// The numbers of the last `draw_ids`.
  [[nodiscard]] Image<std::int32_t> ids();
  /// The depths of the last draw.
  [[nodiscard]] Image<float> depths();

  /// Fragments of each pixel without a depth test, counted by additive blending into float32: exact
  /// below 2²⁴ fragments a pixel.
  [[nodiscard]] Image<std::uint32_t> fragment_counts();
  /// All fragments without a depth test, by GL_SAMPLES_PASSED.
  [[nodiscard]] std::uint64_t samples_passed();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace rastrum::bench
