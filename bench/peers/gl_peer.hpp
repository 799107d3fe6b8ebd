// SPDX-License-Identifier: BSD-3-Clause
// OpenGL without a window, drawn by Mesa's llvmpipe: the peer that the pictures are compared with
// and that the frames are timed against. EGL's surfaceless platform, core profile, one framebuffer
// object with RGBA8 colour and 32-bit float depth, static buffers.
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
/// top-left rule, reversed depth in [0, 1], the first submitted triangle wins equal depths.
/// One at a time in a process; bound to the thread that made it.
class GlPeer {
 public:
  /// Starts EGL with llvmpipe on `threads` rasterizing threads (Mesa reads that once a process).
  /// Throws Error{no_device} saying what is missing.
  explicit GlPeer(int threads = 2);
  ~GlPeer();
  GlPeer(const GlPeer&) = delete;
  GlPeer& operator=(const GlPeer&) = delete;

  /// GL_VERSION and GL_RENDERER.
  [[nodiscard]] std::string description() const;

  /// Copies positions, indices and the normals that share the positions' indices into static
  /// buffers. Throws Error{invalid_argument} where the normals have indices of their own.
  void set_mesh(const MeshView& mesh);
  /// Points of one pixel instead of a mesh, whose ids `draw_ids` draws.
  void set_points(std::span<const Vec3> positions);
  /// Takes `world_to_clip(camera, width, height)`, rounded to float32, and a framebuffer of that
  /// size. Throws Error{unsupported} where the driver has no framebuffer that large.
  void set_view(const Camera& camera, int width, int height);

  /// Clears and draws with `phong`, base (0.8, 0.7, 0.6), and waits for the end (glFinish).
  void draw_phong();
  /// Clears and draws triangle numbers with the depth test, −1 where nothing is; waits.
  void draw_ids();
  /// The colours of the last `draw_phong`.
  [[nodiscard]] Image<Rgba8> colors();
  /// The numbers of the last `draw_ids`.
  [[nodiscard]] Image<std::int32_t> ids();
  /// The depths of the last draw.
  [[nodiscard]] Image<float> depths();

  /// Fragments at each pixel, without a depth test, by additive blending into float32: exact below
  /// 2²⁴ fragments a pixel.
  [[nodiscard]] Image<std::uint32_t> fragment_counts();
  /// Fragments in all, by GL_SAMPLES_PASSED without a depth test.
  [[nodiscard]] std::uint64_t samples_passed();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace rastrum::bench
