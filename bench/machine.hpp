// SPDX-License-Identifier: BSD-3-Clause
// The measured limits of the machine, from which floors are computed.
#pragma once

namespace rastrum::bench {

struct MachineLimits {
  int threads = 0;
  double read_gbs = 0;    ///< reading memory once, 10⁹ bytes a second
  double write_gbs = 0;   ///< plain stores, which read each line before they write it
  double stream_gbs = 0;  ///< streaming stores
  double copy_gbs = 0;    ///< bytes read + bytes written, plain loads, streaming stores
  double gflops_fma = 0;  ///< float32, 10⁹ operations a second; a fused multiply-add counts as 2
  double gflops = 0;      ///< float32, multiply and add unfused, as the picture rules require
};

/// Takes the best of several short runs on `threads` threads at once. Takes about a second and 256
/// MiB a thread.
[[nodiscard]] MachineLimits measure_machine(int threads);

}  // namespace rastrum::bench
