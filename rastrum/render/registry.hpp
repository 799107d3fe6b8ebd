// The registry of rasterizers: a row for each named point of the coverage × visibility table.
#pragma once

#include <functional>
#include <memory>

#include <rastrum/core/memory.hpp>
#include <rastrum/parallel/exec.hpp>
#include <rastrum/raster/geometry.hpp>
#include <rastrum/render/render.hpp>

namespace rastrum {

/// What a rasterizer works with; both outlive it. `threads` is null on Device::serial.
struct RasterizerResources {
  MemoryAccount* memory = nullptr;
  parallel::Threads* threads = nullptr;
};

/// Draws one frame; keeps its scratch from call to call.
using DrawFrame = std::function<FrameStats(raster::FrameRequest&)>;

struct RasterizerRow {
  RasterizerInfo info;
  bool needs_threads = true;
  DrawFrame (*make)(const RasterizerResources&) = nullptr;
};

/// The row that the options name; `auto` is the best of the device.
/// Throws Error{invalid_argument} that lists the names.
[[nodiscard]] const RasterizerRow& find_rasterizer(const RenderOptions& options);

}  // namespace rastrum
