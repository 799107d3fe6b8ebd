// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/raster/rules/clip_code.hpp>
