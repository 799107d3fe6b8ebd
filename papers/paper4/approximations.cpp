// SPDX-License-Identifier: BSD-3-Clause
#include <papers/paper4/approximations.hpp>

#include <array>
#include <memory>

#include <rastrum/error.hpp>
#include <rastrum/family.hpp>
#include <rastrum/raster/context/added_transparency.hpp>

namespace rastrum::family {
namespace {

using Blend = std::unique_ptr<LayerBlend>;

constexpr AddedTransparency approximation(decltype(AddedTransparency::make) make) {
  return {make, 0, "only the CPU has the approximations of transparency"};
}
constexpr auto kWboit =
    approximation([](const TransparencyOptions&, Isa isa) -> Blend { return make_wboit(isa); });
constexpr auto kMlab4 =
    approximation([](const TransparencyOptions&, Isa isa) -> Blend { return make_mlab4(isa); });
constexpr auto kMboit4 =
    approximation([](const TransparencyOptions&, Isa isa) -> Blend { return make_mboit(4, isa); });
constexpr auto kMboit6 =
    approximation([](const TransparencyOptions&, Isa isa) -> Blend { return make_mboit(6, isa); });

/// `filter:1` to `filter:64`.
constexpr auto kFilters = [] {
  std::array<AddedTransparency, 64> methods{};
  for (int k = 1; k <= 64; ++k)
    methods[static_cast<std::size_t>(k - 1)] = {
        transparency::make_exact_blend, k,
        "only the CPU has the filter without repair, since its errors depend on the CPU's blocks"};
  return methods;
}();

[[nodiscard]] TransparencyOptions added(const AddedTransparency& method) {
  return {.method = Transparency::added, .added = &method};
}

}  // namespace

TransparencyOptions wboit() {
  return added(kWboit);
}
TransparencyOptions mlab4() {
  return added(kMlab4);
}
TransparencyOptions mboit4() {
  return added(kMboit4);
}
TransparencyOptions mboit6() {
  return added(kMboit6);
}

TransparencyOptions filtered(int fragments) {
  if (fragments < 1 || fragments > 64)
    throw Error(Errc::invalid_argument, "the filter of transparency must hold 1 to 64 fragments");
  return added(kFilters[static_cast<std::size_t>(fragments - 1)]);
}

}  // namespace rastrum::family
