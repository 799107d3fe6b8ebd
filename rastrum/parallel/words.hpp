// SPDX-License-Identifier: BSD-3-Clause
// All data-parallel words (exec.hpp). Inputs and outputs are the caller's ranges (range.hpp); a
// Buffer is returned only if its size depends on the data. Functors are called concurrently and
// must not share mutable state.
#pragma once

#include <rastrum/parallel/arena.hpp>
#include <rastrum/parallel/blocks.hpp>
#include <rastrum/parallel/exec.hpp>
#include <rastrum/parallel/expand.hpp>
#include <rastrum/parallel/expand_each.hpp>
#include <rastrum/parallel/expand_masked.hpp>
#include <rastrum/parallel/filter.hpp>
#include <rastrum/parallel/for_each.hpp>
#include <rastrum/parallel/mask.hpp>
#include <rastrum/parallel/masked_expansion.hpp>
#include <rastrum/parallel/partition.hpp>
#include <rastrum/parallel/range.hpp>
#include <rastrum/parallel/reduce.hpp>
#include <rastrum/parallel/reduce_by_index.hpp>
#include <rastrum/parallel/reduce_by_key.hpp>
#include <rastrum/parallel/scan.hpp>
#include <rastrum/parallel/scatter.hpp>
#include <rastrum/parallel/scratch.hpp>
#include <rastrum/parallel/segmented.hpp>
#include <rastrum/parallel/selection.hpp>
#include <rastrum/parallel/sort_by_key.hpp>
#include <rastrum/parallel/tabulate.hpp>
#include <rastrum/parallel/transform.hpp>
#include <rastrum/parallel/transpose.hpp>
#include <rastrum/parallel/work_queue.hpp>
