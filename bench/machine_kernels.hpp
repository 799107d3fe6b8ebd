// SPDX-License-Identifier: BSD-3-Clause
// The loops behind machine.hpp, for the best instruction set of this machine. Pointers are aligned
// to 128 bytes; `n` is a multiple of 4,096.
#pragma once

#include <cstddef>

namespace rastrum::bench {

/// The sum of `data`: reads n floats.
float read_floats(const float* data, std::size_t n);
void write_floats(float* data, std::size_t n, float value);
void stream_floats(float* data, std::size_t n, float value);
void copy_floats(const float* from, float* to, std::size_t n);

/// Runs chains of multiply-adds, `steps` long. The result depends on all of them.
float fused_multiply_adds(std::size_t steps, float factor);
float multiplies_and_adds(std::size_t steps, float factor);
/// The operations of both: a multiply and an add in each lane of each chain at each step.
double arithmetic_operations(std::size_t steps);

}  // namespace rastrum::bench
