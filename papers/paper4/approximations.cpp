#include <papers/paper4/approximations.hpp>

#include <array>
#include <memory>

#include <rastrum/error.hpp>
#include <rastrum/family.hpp>
#include <rastrum/raster/context/added_transparency.hpp>

namespace rastrum::family {
namespace {

using Blend = std::unique_ptr<LayerBlend>;

constexpr const char* kNotOnADevice = "the approximations of transparency are the CPU's";

/// `filter:1` to `filter:64`.
constexpr auto kFilters = [] {
  std::array<transparency::AddedMethod, 64> methods{};
  for (int k = 1; k <= 64; ++k)
    methods[static_cast<std::size_t>(k - 1)] = {
        transparency::make_exact_blend, k,
        "the filter without repair, whose errors are those of the CPU's blocks, is the CPU's"};
  return methods;
}();

[[nodiscard]] TransparencyOptions added(const transparency::AddedMethod& method) {
  return {.method = Transparency::added, .added = &method};
}

}  // namespace

TransparencyOptions wboit() {
  static constexpr transparency::AddedMethod method{
      [](const TransparencyOptions&, Isa isa) -> Blend { return make_wboit(isa); }, 0,
      kNotOnADevice};
  return added(method);
}

TransparencyOptions mlab4() {
  static constexpr transparency::AddedMethod method{
      [](const TransparencyOptions&, Isa isa) -> Blend { return make_mlab4(isa); }, 0,
      kNotOnADevice};
  return added(method);
}

TransparencyOptions mboit4() {
  static constexpr transparency::AddedMethod method{
      [](const TransparencyOptions&, Isa isa) -> Blend { return make_mboit(4, isa); }, 0,
      kNotOnADevice};
  return added(method);
}

TransparencyOptions mboit6() {
  static constexpr transparency::AddedMethod method{
      [](const TransparencyOptions&, Isa isa) -> Blend { return make_mboit(6, isa); }, 0,
      kNotOnADevice};
  return added(method);
}

TransparencyOptions filtered(int fragments) {
  if (fragments < 1 || fragments > 64)
    throw Error(Errc::invalid_argument, "the filter of transparency must hold 1 to 64 fragments");
  return added(kFilters[static_cast<std::size_t>(fragments - 1)]);
}

}  // namespace rastrum::family
