// SPDX-License-Identifier: BSD-3-Clause
// A way to find keys: the one fast path, the serial reference, exact layers, a row of the family.
// The driver (driver.hpp) begins and ends a frame, cuts it for a memory limit and makes images from
// keys.
#pragma once

#include <cstdint>
#include <string_view>

#include <rastrum/raster/frame/frame_run.hpp>

namespace rastrum::raster {

struct Needs {
  std::string_view rasterizer, visibility;  ///< as the statistics name them
  /// Draws onto a surface of the whole band; else only where a view has several batches of
  /// triangles.
  bool surface = true;
  int surface_bytes = 8;  ///< a pixel: keys, and what the method keeps beside
  bool colors = false;    ///< fills SurfaceView::colors
  /// Bytes of scratch a triangle, without what it is expanded to.
  int triangle_bytes = 96;
  /// Expands triangles to rows, bins or pairs, and keeps those below FrameRun::expansion_bytes.
  bool expands = false;
  bool quadrics = false;  ///< draws spheres and the like, and round points
  /// Needs all triangles of a view at once. Not batches but the view is cut until they fit
  /// (FrameRun::view_bytes), if the method can tell (`cuts_views`).
  bool whole_view = false, cuts_views = false;
};

class Method {
 public:
  virtual ~Method() = default;
  [[nodiscard]] virtual Needs needs() const = 0;
  /// Draws triangles [first, last) of the frame's numbering into FrameRun::view: onto its surface
  /// or, without one, into tiles of its own that it shades. Names its work in FrameRun::counters.
  /// Where it needs more than FrameRun::view_bytes it draws nothing and clears FrameRun::fits.
  virtual void draw(FrameRun& frame, std::uint64_t first, std::uint64_t last) = 0;
  /// Whether it draws the clusters of prepared meshes (TriangleGroups, with a Selection).
  [[nodiscard]] virtual bool takes_clusters(const FrameRequest& /*request*/) const { return false; }
  /// The frame threw: drops what would reach the next one's statistics.
  virtual void abandon() {}
};

}  // namespace rastrum::raster
