// The names of the façade: shaders and rasterizers.
#include <array>
#include <string>

#include <rastrum/core/error.hpp>
#include <rastrum/render/render.hpp>

namespace rastrum {
namespace {

constexpr std::array<std::string_view, 8> kShaderNames{"flat",    "depth", "normal",   "id",
                                                       "lambert", "phong", "material", "wireframe"};

}  // namespace

std::vector<std::string_view> shader_names() {
  return {kShaderNames.begin(), kShaderNames.end()};
}

std::string_view name(Shader shader) {
  return kShaderNames.at(static_cast<std::size_t>(shader));
}

Shader shader_from_name(std::string_view wanted) {
  std::string known;
  for (std::size_t i = 0; i < kShaderNames.size(); ++i) {
    if (kShaderNames[i] == wanted) return static_cast<Shader>(i);
    known += (i == 0 ? "" : ", ") + std::string(kShaderNames[i]);
  }
  throw Error(Errc::invalid_argument,
              "no shader is called '" + std::string(wanted) + "'; there are " + known);
}

const std::vector<RasterizerInfo>& rasterizers() {
  static const std::vector<RasterizerInfo> table{
      {"reference", "scanline", "atomic",
       "rows of triangles in order into one visibility buffer; one thread, plain C++"},
      {"tiled", "tiled", "atomic",
       "(bin, piece) pairs sorted by bin; a thread owns a bin and shades it in cache"},
  };
  return table;
}

}  // namespace rastrum
