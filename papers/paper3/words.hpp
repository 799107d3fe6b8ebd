// SPDX-License-Identifier: BSD-3-Clause
// Paper 3's `words` as a method of a TerrainRenderer, drawn by words_listing.hpp.
#pragma once

#include <rastrum/parallel/exec.hpp>
#include <rastrum/terrain.hpp>
#include <rastrum/terrain/methods.hpp>
#include <rastrum/terrain/samples.hpp>

namespace rastrum::family {

terrain::Counts draw_words(parallel::Serial& exec, const terrain::Samples& samples,
                           const terrain::TerrainTargets& targets);
terrain::Counts draw_words(parallel::Threads& exec, const terrain::Samples& samples,
                           const terrain::TerrainTargets& targets);

}  // namespace rastrum::family
