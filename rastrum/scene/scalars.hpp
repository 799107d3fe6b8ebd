// SPDX-License-Identifier: BSD-3-Clause
// The scalars of an instance.
#pragma once

#include <rastrum/scene.hpp>

namespace rastrum {

/// The instance's own number, else its geometry's. Except for meshes, Per::vertex means one per
/// position or primitive. `instance` must outlive the result.
[[nodiscard]] MeshScalarsView scalars_of(const InstanceView& instance);

}  // namespace rastrum
