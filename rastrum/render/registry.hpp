// The choice of a rasterizer: a point of the coverage × visibility table, or the serial reference.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>

#include <rastrum/core/memory.hpp>
#include <rastrum/parallel/exec.hpp>
#include <rastrum/raster/frame/request.hpp>
#include <rastrum/render/render.hpp>

namespace rastrum {

/// Whether a draw has translucent primitives, and they are not to be drawn opaque.
[[nodiscard]] bool blends(std::span<const raster::Draw> draws, const TransparencyOptions& options);

/// Draws one frame; keeps its scratch from call to call.
using DrawFrame = std::function<FrameStats(raster::FrameRequest&)>;

/// What the options name; `auto` is chosen anew for each frame, from its size alone. `threads` is
/// null for the serial reference; both outlive the result. `automatic_why`: what Device::automatic
/// took CUDA for; each frame is then the device's only if it is expected to be worth it
/// (device_work.hpp). Throws Error{invalid_argument} that lists the names, or the tunings that were
/// compiled.
[[nodiscard]] DrawFrame make_rasterizer(const RenderOptions& options, MemoryAccount& memory,
                                        parallel::Threads* threads,
                                        const std::string& automatic_why = {});

}  // namespace rastrum
