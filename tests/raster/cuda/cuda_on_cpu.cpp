// SPDX-License-Identifier: BSD-3-Clause
// A program whose device is the CPU: the linked device code (tests/CMakeLists.txt) replaces the
// library that would be opened, and this file replaces the driver.
#include <rastrum/parallel/cuda/driver.hpp>
#include <rastrum/parallel/cuda/host_stream.hpp>
#include <rastrum/parallel/cuda/host_walls.hpp>
#include <rastrum/parallel/cuda/library.hpp>

namespace rastrum::parallel {
namespace {

[[maybe_unused]] const bool is_taken =
    (set_cuda_library(*rastrum_cuda_library()), cuda_system::HostStream::be_late(true),
     cuda_system::Walls::stand(), true);

}  // namespace

CudaStatus driver_status() {
  return {.usable = true, .why_not = {}, .name = "CPU that stands for a GPU"};
}

}  // namespace rastrum::parallel
