// SPDX-License-Identifier: BSD-3-Clause
// The same as the public function, with a place for tests to fail at, and with edges.
#pragma once

#include <rastrum/effects.hpp>
#include <rastrum/ranks/agree.hpp>

namespace rastrum::ranks {

/// Edges of the triangles that are seen, beside a frame whose ids are asked for: of each pixel by
/// who has won it.
struct EdgesOfParts {
  EdgeLines lines;            ///< the same on all ranks
  ImageView<float> factor{};  ///< the root's, as Effects::edges fills it
};

RanksStats render_parts(Communicator& ranks, Renderer& renderer, const SceneView& scene,
                        std::span<const std::uint64_t> parts, const Camera& camera,
                        const FrameOptions& frame, const Targets& targets,
                        const RanksOptions& options, const AtPhase& at,
                        const EdgesOfParts* edges = nullptr, StopToken stop = {});

}  // namespace rastrum::ranks
