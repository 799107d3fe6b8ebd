// Paper 3's words on the CPU.
#include <rastrum/terrain/words_listing.hpp>

namespace rastrum::terrain {

Counts draw_words(parallel::Serial& exec, const Samples& samples, const TerrainTargets& targets) {
  return draw_by_words(exec, samples, targets);
}
Counts draw_words(parallel::Threads& exec, const Samples& samples, const TerrainTargets& targets) {
  return draw_by_words(exec, samples, targets);
}

}  // namespace rastrum::terrain
