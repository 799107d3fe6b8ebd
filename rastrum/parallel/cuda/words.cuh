// SPDX-License-Identifier: BSD-3-Clause
// All data-parallel words on a CUDA device. Two of words.hpp are missing, whose threads have state:
// for_each_team (exec.cuh) stands for for_each_with_scratch, and there is no WorkQueue.
#pragma once

#include <rastrum/parallel/cuda/buffer.cuh>
#include <rastrum/parallel/cuda/by_key.cuh>
#include <rastrum/parallel/cuda/elementwise.cuh>
#include <rastrum/parallel/cuda/exec.cuh>
#include <rastrum/parallel/cuda/expand.cuh>
#include <rastrum/parallel/cuda/order.cuh>
#include <rastrum/parallel/cuda/reduce.cuh>
#include <rastrum/parallel/cuda/reduce_by_index.cuh>
#include <rastrum/parallel/cuda/select.cuh>
#include <rastrum/parallel/cuda/sort_by_key.cuh>
#include <rastrum/parallel/cuda/system.cuh>
#include <rastrum/parallel/words.hpp>
