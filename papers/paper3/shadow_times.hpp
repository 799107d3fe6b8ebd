// SPDX-License-Identifier: BSD-3-Clause
// Shadows beside each other for `rastrum bench paper3`: paper 3's march (section 6.2, figures 6.7
// to 6.9: over columns q of the map and samples d_c) and our exact sharp shadows.
#pragma once

#include <rastrum/image.hpp>

#include <bench/tables/document.hpp>
#include <bench/tables/options.hpp>

namespace rastrum::bench {

/// Adds two tables: both over q and d_c, and march over sharp by the sun's place on a square map,
/// where issue 5 asks for 20; the first with a CUDA device's times where the options have one.
/// `heights` repeat where a map is larger. Returns false where the device's shadows are not the
/// threads'.
bool add_shadow_times(const TableOptions& options, const Image<float>& heights, Document& document);

}  // namespace rastrum::bench
