// The names of the façade: shaders and rasterizers.
#include <array>
#include <memory>
#include <string>

#include <rastrum/core/error.hpp>
#include <rastrum/raster/reference.hpp>
#include <rastrum/raster/tiled.hpp>
#include <rastrum/render/registry.hpp>

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

namespace {

DrawFrame make_reference(const RasterizerResources& with) {
  return [memory = with.memory](raster::FrameRequest& request) {
    return raster::render_reference(request, *memory);
  };
}

DrawFrame make_tiled(const RasterizerResources& with) {
  auto tiled = std::make_shared<raster::TiledRasterizer>(*with.memory);
  return [tiled, threads = with.threads](raster::FrameRequest& request) {
    return tiled->render(request, *threads);
  };
}

const std::vector<RasterizerRow>& rows() {
  static const std::vector<RasterizerRow> table{
      {{"reference", "scanline", "atomic",
        "rows of triangles in order into one visibility buffer; one thread, plain C++"},
       false,
       make_reference},
      {{"tiled", "tiled", "atomic",
        "(bin, piece) pairs sorted by bin; a thread owns a bin and shades it in cache"},
       true,
       make_tiled},
  };
  return table;
}

}  // namespace

const std::vector<RasterizerInfo>& rasterizers() {
  static const std::vector<RasterizerInfo> infos = [] {
    std::vector<RasterizerInfo> list;
    for (const RasterizerRow& row : rows()) list.push_back(row.info);
    return list;
  }();
  return infos;
}

const RasterizerRow& find_rasterizer(const RenderOptions& options) {
  const bool serial = options.device == Device::serial;
  const std::string wanted =
      options.rasterizer == "auto" ? (serial ? "reference" : "tiled") : options.rasterizer;
  std::string known = "auto";
  for (const RasterizerRow& row : rows()) {
    if (row.info.name == wanted) {
      if (serial && row.needs_threads)
        throw Error(Errc::invalid_argument, "the rasterizer '" + wanted +
                                                "' needs --device threads; serial has 'reference'");
      return row;
    }
    known += ", " + row.info.name;
  }
  throw Error(Errc::invalid_argument,
              "no rasterizer is called '" + wanted + "'; there are " + known);
}

}  // namespace rastrum
