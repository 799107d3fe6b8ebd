// SPDX-License-Identifier: BSD-3-Clause
// KHR_lights_punctual: the document's lights, which nodes place.
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include <rastrum/error.hpp>
#include <rastrum/io/gltf_internal.hpp>
#include <rastrum/light.hpp>

namespace rastrum::io::gltf {
namespace {

constexpr const char* kLights = "KHR_lights_punctual";

float at_least_zero(const Json& light, const char* key, float otherwise) {
  const float value = light.real(key, otherwise);
  if (value < 0) light.fail(std::string(key) + " must not be negative");
  return value;
}

Vec3 color_of(const Json& light) {
  const auto color = light.get("color");
  if (!color) return {1, 1, 1};
  if (color->size() != 3) color->fail("must have three numbers");
  const Vec3 c{color->at(0).real(), color->at(1).real(), color->at(2).real()};
  if (c.x < 0 || c.y < 0 || c.z < 0) color->fail("must not be negative");
  return c;
}

float range_of(const Json& light) {
  const auto range = light.get("range");
  if (!range) return std::numeric_limits<float>::infinity();
  const float r = range->real();
  if (!(r > 0)) range->fail("must be greater than 0");
  return r;
}

SpotLight spot_of(const Json& light) {
  SpotLight spot;
  spot.range = range_of(light);
  const auto cone = light.get("spot");
  if (!cone) light.fail("a spot must have its cone");
  spot.inner_rad = cone->real("innerConeAngle", 0);
  spot.outer_rad = cone->real("outerConeAngle", std::numbers::pi_v<float> / 4);
  if (!(spot.inner_rad >= 0 && spot.inner_rad < spot.outer_rad &&
        spot.outer_rad <= std::numbers::pi_v<float> / 2))
    cone->fail("its angles must be 0 <= innerConeAngle < outerConeAngle <= pi / 2");
  return spot;
}

std::optional<Light> light_of(const Json& json) {
  Light light;
  const std::string& type = json["type"].string();
  light.color = color_of(json);
  // Lux and candela measure arriving light; ours is what a white surface reflects.
  light.intensity = at_least_zero(json, "intensity", 1) * std::numbers::inv_pi_v<float>;
  if (type == "directional")
    light.kind = DirectionalLight{};
  else if (type == "point")
    light.kind = PointLight{{}, range_of(json)};
  else if (type == "spot")
    light.kind = spot_of(json);
  else
    return std::nullopt;
  try {
    check_lights({&light, 1});
  } catch (const Error& e) {
    json.fail(e.what());
  }
  return light;
}

}  // namespace

std::vector<std::optional<Light>> read_lights(const Json& document) {
  std::vector<std::optional<Light>> lights;
  if (const auto extension = document.extension(kLights))
    extension->for_each("lights", [&](const Json& l) { lights.push_back(light_of(l)); });
  return lights;
}

std::optional<std::size_t> light_of_node(const Json& node, std::size_t lights) {
  const auto extension = node.extension(kLights);
  if (!extension) return std::nullopt;
  return (*extension)["light"].index(lights);
}

}  // namespace rastrum::io::gltf
