// SPDX-License-Identifier: BSD-3-Clause
// The public function, with edges and a hook for tests to fail at.
#pragma once

#include <rastrum/effects.hpp>
#include <rastrum/ranks/agree.hpp>

namespace rastrum::ranks {

/// Edges of the visible triangles, for a frame whose ids are asked for. The rank that wins a pixel
/// computes its edges.
struct EdgesOfParts {
  EdgeLines lines;            ///< the same on all ranks
  ImageView<float> factor{};  ///< on the root, as Effects::edges fills it
};

RanksStats render_parts(Communicator& ranks, Renderer& renderer, const SceneView& scene,
                        std::span<const std::uint64_t> parts, const Camera& camera,
                        const FrameOptions& frame, const Targets& targets,
                        const RanksOptions& options, const AtPhase& at,
                        const EdgesOfParts* edges = nullptr, StopToken stop = {});

}  // namespace rastrum::ranks
