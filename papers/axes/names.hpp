// SPDX-License-Identifier: BSD-3-Clause
// Makes the renderer's names visible in the family, which defines none of them itself.
#pragma once

namespace rastrum {
namespace raster {}
namespace family {
using namespace raster;  // NOLINT(google-build-using-namespace)
}
}  // namespace rastrum
