// How many generated scenes a test draws.
#pragma once

#include <cstdlib>

namespace rastrum::test {

/// `all`; `few`, each kind of them, where RASTRUM_FEW_SCENES is set: under the sanitizers,
/// which look for wrong memory and races while the other builds compare all numbers (decision
/// 0088).
[[nodiscard]] inline int scene_count(int all, int few) {
  return std::getenv("RASTRUM_FEW_SCENES") != nullptr ? few : all;
}

}  // namespace rastrum::test
