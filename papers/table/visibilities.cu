// SPDX-License-Identifier: BSD-3-Clause
// Instantiates the visibilities of the family on a device.
#include <array>

#include <papers/axes/atomic.cuh>
#include <papers/paper1/search.cuh>
#include <papers/paper1/tuple.cuh>
#include <papers/paper5/hashed.cuh>
#include <papers/paper5/sorted.cuh>
#include <papers/table/family.cuh>

namespace rastrum::family {

template <class Visibility, class Exec>
std::unique_ptr<DeviceVisibility<Exec>> make(FamilyFrame<Exec>& frame) {
  return std::make_unique<Visibility>(frame);
}

template <class Exec>
inline constexpr std::array kVisibilities{
    VisibilityOnDevice<Exec>{"atomic", 0, false, make<AtomicOnDevice<Exec>, Exec>},
    VisibilityOnDevice<Exec>{"search", sizeof(std::uint32_t), false,
                             make<SearchOnDevice<Exec>, Exec>},
    VisibilityOnDevice<Exec>{"tuple", sizeof(Vec4), true, make<TupleOnDevice<Exec>, Exec>},
    VisibilityOnDevice<Exec>{"sorted", 0, false, make<SortedOnDevice<Exec>, Exec>},
    VisibilityOnDevice<Exec>{"hashed", 0, false, make<HashedOnDevice<Exec>, Exec>},
};

template <class Exec>
std::span<const VisibilityOnDevice<Exec>> visibilities_on_device() {
  return kVisibilities<Exec>;
}
template std::span<const VisibilityOnDevice<parallel::Cuda>>
visibilities_on_device<parallel::Cuda>();

}  // namespace rastrum::family
