// SPDX-License-Identifier: BSD-3-Clause
// Translucent surfaces by OpenGL (llvmpipe) in three usual ways: blended unsorted, exact by
// per-pixel linked lists (Yang et al. 2010), exact by front-to-back depth peeling (Everitt 2001).
// All shade `phong` as GlPeer does, with one opacity, premultiplied, over nothing.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <string_view>

#include <rastrum/camera.hpp>
#include <rastrum/image.hpp>
#include <rastrum/mesh.hpp>

namespace rastrum::bench {

enum class GlBlending : std::uint8_t { unsorted, lists, peeling };
[[nodiscard]] constexpr std::string_view name(GlBlending method) {
  constexpr std::string_view kNames[]{"unsorted", "lists", "peeling"};
  return kNames[static_cast<std::size_t>(method)];
}

/// The blending format: RGBA8 as users have it, or RGBA32F for comparisons with ours. The lists'
/// colours are half floats in both.
enum class GlPrecision : std::uint8_t { rgba8, float32 };

/// Only one at a time in a process, GlPeer included; bound to the thread that made it.
class GlTransparency {
 public:
  /// A node of the lists: colour as four half floats, depth, the next node's number.
  static constexpr std::uint64_t kNodeBytes = 16;

  /// As GlPeer's.
  explicit GlTransparency(int threads = 2);
  ~GlTransparency();
  GlTransparency(const GlTransparency&) = delete;
  GlTransparency& operator=(const GlTransparency&) = delete;

  [[nodiscard]] std::string description() const;
  void set_mesh(const MeshView& mesh);
  /// Also counts the fragments in an untimed pass, so that the lists are large enough.
  void set_view(const Camera& camera, int width, int height);
  /// The view's fragments, counted without a depth test.
  [[nodiscard]] std::uint64_t fragments() const;

  struct Frame {
    int passes = 1;        ///< over the geometry; peeling's last one finds nothing
    bool complete = true;  ///< false: peeling ran out of time, layers are missing
  };
  /// Clears, draws, and waits for the end (glFinish). Peeling stops after a pass that ends later
  /// than `patience_ms`. Like all peeling it keeps only the first of the fragments of equal depth
  /// in a pixel. Throws Error{out_of_memory} if the lists exceed what the driver binds (117 million
  /// fragments with llvmpipe).
  Frame draw(GlBlending method, float opacity, GlPrecision precision,
             double patience_ms = std::numeric_limits<double>::infinity());
  /// The last draw's picture, premultiplied.
  [[nodiscard]] Image<Vec4> picture();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace rastrum::bench
