// SPDX-License-Identifier: BSD-3-Clause
// The family stands on the renderer's rooms, and names nothing that they have.
#pragma once

namespace rastrum {
namespace raster {}
namespace family {
using namespace raster;  // NOLINT(google-build-using-namespace)
}
}  // namespace rastrum
