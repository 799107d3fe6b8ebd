// SPDX-License-Identifier: BSD-3-Clause
// Properties of the whole scene on which ranks agree before they draw.
#pragma once

#include <vector>

#include <rastrum/ranks/agree.hpp>
#include <rastrum/scene.hpp>

namespace rastrum::ranks {

/// Whether a mapping takes its range from the scene's numbers.
[[nodiscard]] inline bool takes_range(const ScalarMapping& m) {
  return !m.range && m.categories.empty();
}

/// As mappings_of_ranks(), with a hook for tests to make phases fail.
[[nodiscard]] std::vector<ScalarMapping> mappings_of(Communicator& ranks, const AtPhase& at,
                                                     const SceneView& scene);

}  // namespace rastrum::ranks
