// SPDX-License-Identifier: BSD-3-Clause
// The kernels of all approximations, in lanes of pixels or in one float.
#include <papers/paper4/moment_passes.inl>
#include <papers/paper4/multi_layer.inl>
#include <papers/paper4/weighted.inl>

constexpr ApproximationKernels kTable{kMomentKernels<2>, kMomentKernels<3>, kWeighted, kMultiLayer};
