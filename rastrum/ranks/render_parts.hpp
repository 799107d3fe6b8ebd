// The same as the public function, with a place for tests to fail at.
#pragma once

#include <rastrum/ranks/agree.hpp>

namespace rastrum::ranks {

RanksStats render_parts(Communicator& ranks, Renderer& renderer, const SceneView& scene,
                        std::span<const std::uint64_t> parts, const Camera& camera,
                        const FrameOptions& frame, const Targets& targets,
                        const RanksOptions& options, const AtPhase& at);

}  // namespace rastrum::ranks
