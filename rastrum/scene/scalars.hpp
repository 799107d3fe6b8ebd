// What numbers an instance has.
#pragma once

#include <rastrum/scene.hpp>

namespace rastrum {

/// Its own number, else its geometry's; of what is no mesh Per::vertex means one a position, or
/// primitive. `instance` must outlive the result.
[[nodiscard]] MeshScalarsView scalars_of(const InstanceView& instance);

}  // namespace rastrum
