// SPDX-License-Identifier: BSD-3-Clause
#include <papers/paper3/words.hpp>

#include <algorithm>
#include <memory>

#include <papers/axes/cuda_rows.hpp>
#include <papers/paper3/words_listing.hpp>
#include <rastrum/family.hpp>
#include <rastrum/terrain/added_method.hpp>
#include <rastrum/terrain/cuda/device.hpp>

namespace rastrum::family {

terrain::Counts draw_words(parallel::Serial& exec, const terrain::Samples& samples,
                           const terrain::TerrainTargets& targets) {
  return draw_by_words(exec, samples, targets);
}
terrain::Counts draw_words(parallel::Threads& exec, const terrain::Samples& samples,
                           const terrain::TerrainTargets& targets) {
  return draw_by_words(exec, samples, targets);
}

namespace {

std::unique_ptr<terrain::DeviceRenderer> make_device_renderer() {
  return cuda_rows().make_terrain_renderer();
}

/// Memory of a batch's pairs, two screens, and Thrust's scratch. An arena rounds blocks up by a
/// quarter.
std::uint64_t device_bytes(std::uint64_t slices) {
  constexpr std::uint64_t kBytes = 64;
  return kBytes * std::max<std::uint64_t>(words_detail::kBatch, slices) / 4 * 5;
}

/// On threads about 35 times as long as `fast`, within a factor of 1.7 (docs/log/terrain.md). The
/// factor for a device is a guess for an A100: pairs are written and scanned.
void weigh(FrameWork& work) {
  work.host_ns *= 35;
  work.device_ns *= 20;
  work.launches = 60;
}

}  // namespace

const terrain::AddedMethod& terrain_words() {
  static constexpr terrain::AddedMethod method{draw_words, draw_words, make_device_renderer,
                                               device_bytes, weigh};
  return method;
}

}  // namespace rastrum::family
