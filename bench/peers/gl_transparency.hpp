// SPDX-License-Identifier: BSD-3-Clause
// Translucent surfaces by OpenGL (llvmpipe), three ways that users have: blended unsorted, exact by
// per-pixel linked lists (Yang et al. 2010), exact by front-to-back depth peeling (Everitt 2001).
// All shade `phong` as GlPeer does, every surface with one opacity, premultiplied, over nothing.
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

/// The format that the picture is blended in: RGBA8 as users have it, or RGBA32F to be compared
/// with ours. The lists' colours are half floats in both.
enum class GlPrecision : std::uint8_t { rgba8, float32 };

/// One at a time in a process, GlPeer included; bound to the thread that made it.
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
  /// Also counts the fragments, so that the lists are large enough: a pass that no draw pays for.
  void set_view(const Camera& camera, int width, int height);
  /// The view's fragments, counted without a depth test.
  [[nodiscard]] std::uint64_t fragments() const;

  struct Frame {
    int passes = 1;        ///< over the geometry; peeling's last one finds nothing
    bool complete = true;  ///< false: peeling ran out of patience, layers are missing
  };
  /// Clears and draws, and waits for the end (glFinish). Peeling stops after a pass that ends later
  /// than `patience_ms`, and loses fragments of equal depth, all but the first one of each pixel,
  /// as it does everywhere. Throws Error{out_of_memory} where the lists exceed what the driver
  /// binds (117 million fragments with llvmpipe).
  Frame draw(GlBlending method, float opacity, GlPrecision precision,
             double patience_ms = std::numeric_limits<double>::infinity());
  /// The last draw's picture, premultiplied.
  [[nodiscard]] Image<Vec4> picture();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace rastrum::bench
