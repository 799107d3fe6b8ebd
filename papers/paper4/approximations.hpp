// SPDX-License-Identifier: BSD-3-Clause
// The published approximations of transparency. They take the same fragments as the exact blending
// (blend.hpp), in order of submission, so that all differences in the picture are theirs.
#pragma once

#include <memory>

#include <rastrum/transparency/blend.hpp>

namespace rastrum::family {

using transparency::Layer;
using transparency::LayerBlend;

/// McGuire and Bavoil, "Weighted Blended Order-Independent Transparency", JCGT 2013.
[[nodiscard]] std::unique_ptr<LayerBlend> make_wboit(Isa isa);

/// Salvi and Vaidyanathan, "Multi-Layer Alpha Blending", I3D 2014, with four layers.
[[nodiscard]] std::unique_ptr<LayerBlend> make_mlab4(Isa isa);

/// Münstermann, Krumpen, Klein and Peters, "Moment-Based Order-Independent Transparency", I3D 2018,
/// with 4 or 6 power moments.
[[nodiscard]] std::unique_ptr<LayerBlend> make_mboit(int moments, Isa isa);

}  // namespace rastrum::family
