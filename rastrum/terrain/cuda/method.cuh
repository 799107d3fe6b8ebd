// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <rastrum/parallel/cuda/exec.cuh>
#include <rastrum/terrain/methods.hpp>
#include <rastrum/terrain/samples.hpp>

namespace rastrum::terrain {

struct FunctionSamples;  // functions.cuh

struct MethodOnDevice {
  Counts (*of_map)(parallel::Cuda& exec, const MapSamples& samples,
                   const TerrainTargets& targets) = nullptr;
  Counts (*of_function)(parallel::Cuda& exec, const FunctionSamples& samples,
                        const TerrainTargets& targets) = nullptr;
};

}  // namespace rastrum::terrain
