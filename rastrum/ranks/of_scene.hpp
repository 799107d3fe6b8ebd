// What of a whole scene its ranks agree on before they draw.
#pragma once

#include <vector>

#include <rastrum/ranks/agree.hpp>
#include <rastrum/scene.hpp>

namespace rastrum::ranks {

/// Whether a mapping takes the range of the numbers that are there.
[[nodiscard]] inline bool takes_range(const ScalarMapping& m) {
  return !m.range && m.categories.empty();
}

/// mappings_of_ranks(), where a test may fail, too.
[[nodiscard]] std::vector<ScalarMapping> mappings_of(Communicator& ranks, const AtPhase& at,
                                                     const SceneView& scene);

}  // namespace rastrum::ranks
