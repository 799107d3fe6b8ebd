// SPDX-License-Identifier: BSD-3-Clause
// Shadow times for `rastrum bench paper3`: paper 3's march (section 6.2, figures 6.7 to 6.9: over
// columns q of the map and samples d_c) beside our exact sharp shadows.
#pragma once

#include <rastrum/image.hpp>

#include <bench/tables/document.hpp>
#include <bench/tables/options.hpp>

namespace rastrum::bench {

/// Adds two tables: both methods over q and d_c, with a CUDA device's times if the options have
/// one; and march over sharp by the sun's place on a square map (goal: 20). `heights` repeat on
/// larger maps. Returns false if the device's shadows differ from the threads'.
bool add_shadow_times(const TableOptions& options, const Image<float>& heights, Document& document);

}  // namespace rastrum::bench
