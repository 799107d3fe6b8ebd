// The program without CUDA. choose_device has said so before anybody comes here.
#include <rastrum/core/error.hpp>
#include <rastrum/terrain/cuda/device.hpp>

namespace rastrum::terrain {
namespace {

[[noreturn]] void refuse() {
  throw Error(Errc::no_device, "terrain: this program was built without CUDA");
}

}  // namespace

std::unique_ptr<DeviceRenderer> make_device_renderer() {
  refuse();
}
Image<std::uint8_t> sharp_shadows_on_device(ImageView<const float>, const Sun&, Tiling) {
  refuse();
}
Image<std::uint8_t> light_of_suns_on_device(ImageView<const float>, std::span<const Sun>, Tiling) {
  refuse();
}
Image<std::uint16_t> hidden_samples_on_device(ImageView<const float>, const Sun&, const March&,
                                              Tiling) {
  refuse();
}

}  // namespace rastrum::terrain
