// SPDX-License-Identifier: BSD-3-Clause
// All the data-parallel words on a CUDA device, but for those of words.hpp that are loops of
// threads with a state of their own: for_each_with_scratch is for_each_team (exec.cuh) here, and
// there is no WorkQueue.
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
