// SPDX-License-Identifier: BSD-3-Clause
// The reference: rows of samples, triangle after triangle, on one thread, into the maximum of keys
// in a full-frame visibility buffer. Written for plainness; all others must equal it.
#pragma once

#include <memory>

#include <rastrum/raster/draws/numbering.hpp>
#include <rastrum/raster/frame/method.hpp>
#include <rastrum/raster/resolve/resolve.hpp>
#include <rastrum/raster/setup/assemble.hpp>
#include <rastrum/stop.hpp>

namespace rastrum::raster {

/// Calls f(draw, primitive) for primitives [first, last) of the frame's numbering, in order, until
/// a stop is asked for. Throws Error{invalid_argument} naming an index that is out of range.
template <class F>
void for_each_primitive(const FrameRun& frame, std::uint64_t first, std::uint64_t last,
                        const F& f) {
  check_indices(frame.request.draws, frame.request.names);
  for (std::uint64_t id = first; id < last; ++id) {
    throw_if_stopped();
    const Draw& draw = frame.geometry.draw_of(id);
    f(draw, id - draw.first_id);
  }
}

inline void count_fate(Fate fate, FrameStats::Triangles& triangles) {
  triangles.dropped += fate == Fate::dropped;
  triangles.culled += fate == Fate::culled;
  triangles.clipped += fate == Fate::clipped;
}

[[nodiscard]] std::unique_ptr<Method> make_reference();

}  // namespace rastrum::raster
