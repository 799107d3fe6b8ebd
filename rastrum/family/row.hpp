// A row of the table as a method: a coverage and a visibility.
#pragma once

#include <memory>

#include <rastrum/core/memory.hpp>
#include <rastrum/family/coverage/coverage.hpp>
#include <rastrum/family/visibility/region.hpp>
#include <rastrum/raster/frame/method.hpp>

namespace rastrum::family {

/// What is given outlives the method. Frames need threads.
/// `hierarchical_z`: what is hidden is left out, where the row can; no pixel changes.
/// Throws Error{invalid_argument} for a tuning that the coverage does not take.
[[nodiscard]] std::unique_ptr<Method> make_row(const CoverageRow& coverage,
                                               const Visibility& visibility, const Tuning& tuning,
                                               bool hierarchical_z, MemoryAccount& memory);

}  // namespace rastrum::family
