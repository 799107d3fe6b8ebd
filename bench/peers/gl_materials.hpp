// SPDX-License-Identifier: BSD-3-Clause
// The `material` shader on OpenGL: the formula of rastrum/raster/shade/material.hpp in GLSL, drawn
// forward by Mesa's llvmpipe, one draw per material.
#pragma once

#include <memory>
#include <string>

#include <rastrum/camera.hpp>
#include <rastrum/image.hpp>
#include <rastrum/scene.hpp>

namespace rastrum::bench {

/// Draws one scene at a time by the conventions of `docs/conventions.md`. Triangles are sorted by
/// material, masked ones last, so equal depths may resolve differently from ours. Only one OpenGL
/// peer at a time in a process; bound to the thread that made it.
class GlMaterials {
 public:
  /// Starts llvmpipe like GlContext. Throws Error{no_device}, which says what is missing.
  explicit GlMaterials(int threads = 2);
  ~GlMaterials();
  GlMaterials(const GlMaterials&) = delete;
  GlMaterials& operator=(const GlMaterials&) = delete;

  /// GL_VERSION and GL_RENDERER.
  [[nodiscard]] std::string description() const;

  /// Copies the meshes into static buffers (equal corners share a vertex) and the textures with our
  /// own levels, so that pictures differ only by the filter. Throws Error{unsupported} for what the
  /// peer cannot draw: materials that blend, are unlit or have normal maps, and instances with a
  /// look of their own.
  void set_scene(const SceneView& scene);
  /// As GlPeer's, for perspective cameras (else Error{unsupported}).
  void set_view(const Camera& camera, int width, int height);

  /// Clears, draws and waits for the end (glFinish).
  void draw();
  /// The display colours of the last `draw`.
  [[nodiscard]] Image<Rgba8> colors();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace rastrum::bench
