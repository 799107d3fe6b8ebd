// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/shapes.hpp>

#include <utility>

#include <rastrum/core/float_scope.hpp>
#include <rastrum/error.hpp>

namespace rastrum {

Scene sprite(Image<Rgba8> picture) {
  const FloatScope floats;
  if (picture.empty()) throw Error(Errc::invalid_argument, "a sprite needs a picture");
  const float half = static_cast<float>(picture.width()) / static_cast<float>(picture.height()) / 2;
  Mesh quad;
  quad.name = "sprite";
  quad.positions = {{-half, 0, 0}, {half, 0, 0}, {half, 1, 0}, {-half, 1, 0}};
  quad.indices = {0, 1, 2, 0, 2, 3};
  quad.texcoords.values = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
  Material material;
  material.name = quad.name;
  material.base_color_texture = 0;
  material.alpha_mode = AlphaMode::blend;
  material.double_sided = true;
  material.unlit = true;
  Texture texture;
  texture.name = quad.name;
  texture.image = std::move(picture);
  texture.wrap_u = texture.wrap_v = Wrap::clamp_to_edge;

  Scene scene;
  scene.meshes.push_back(std::move(quad));
  scene.instances.push_back({});
  scene.materials.push_back(std::move(material));
  scene.textures.push_back(std::move(texture));
  return scene;
}

}  // namespace rastrum
