#include <rastrum/family/blend/approximations.hpp>

namespace rastrum::family {

std::unique_ptr<LayerBlend> make_blend(const TransparencyOptions& options, Isa isa) {
  switch (options.method) {
    case Transparency::wboit:
      return make_wboit(isa);
    case Transparency::mlab4:
      return make_mlab4(isa);
    case Transparency::mboit4:
      return make_mboit(4, isa);
    case Transparency::mboit6:
      return make_mboit(6, isa);
    default:
      return transparency::make_blend(options, isa);
  }
}

}  // namespace rastrum::family
