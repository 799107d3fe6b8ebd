// What a frame of triangles is expected to cost, for Device::automatic
// (parallel/device_estimate.hpp).
#pragma once

#include <rastrum/parallel/device_estimate.hpp>
#include <rastrum/raster/frame/request.hpp>

namespace rastrum {

/// By its primitives and pixels, the arrays that go over and the targets that come back. How many
/// samples they cover nobody knows before: layers count as one surface.
[[nodiscard]] FrameWork device_work(const raster::FrameRequest& request);

}  // namespace rastrum
