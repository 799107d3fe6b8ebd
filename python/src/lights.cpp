// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <rastrum/core/srgb.hpp>
#include <rastrum/io.hpp>
#include <rastrum/light.hpp>

#include "bindings.hpp"

namespace rastrum::python {
namespace {

using Numbers3 = std::array<double, 3>;
/// ClassicLight's fields, one after the other.
using Classic = std::array<double, 13>;

ClassicLight classic_light(const Classic& c) {
  const auto vec3 = [&](std::size_t i) { return Vec3(Vec3d{c[i], c[i + 1], c[i + 2]}); };
  return {vec3(0), vec3(3), vec3(6), vec3(9), static_cast<float>(c[12])};
}

Light light(const std::string& kind, const Numbers3& place, const Numbers3& direction,
            const Numbers3& below, double range, double inner_rad, double outer_rad,
            const Numbers3& color, double intensity, bool of_camera, bool casts_shadows,
            const std::optional<Classic>& classic) {
  const auto vec3 = [](const Numbers3& v) { return Vec3(Vec3d{v[0], v[1], v[2]}); };
  const Vec3d at{place[0], place[1], place[2]};
  Light l;
  if (kind == "ambient")
    l.kind = AmbientLight{};
  else if (kind == "hemisphere")
    l.kind = HemisphereLight{vec3(direction), vec3(below)};
  else if (kind == "directional")
    l.kind = DirectionalLight{vec3(direction)};
  else if (kind == "point")
    l.kind = PointLight{at, static_cast<float>(range)};
  else if (kind == "spot")
    l.kind = SpotLight{at, vec3(direction), static_cast<float>(range),
                       static_cast<float>(inner_rad), static_cast<float>(outer_rad)};
  else
    throw Error(Errc::invalid_argument,
                "kind: there is no " + kind +
                    "; take one of ambient, hemisphere, directional, point, spot");
  l.color = vec3(color);
  l.intensity = static_cast<float>(intensity);
  l.of_camera = of_camera;
  l.casts_shadows = casts_shadows;
  if (classic) l.classic = classic_light(*classic);
  check_lights({&l, 1});
  return l;
}

Light environment(const Environment& picture, const Numbers3& up, double turn_rad,
                  const Numbers3& color, double intensity, bool of_camera) {
  const auto vec3 = [](const Numbers3& v) { return Vec3(Vec3d{v[0], v[1], v[2]}); };
  Light l;
  l.kind = EnvironmentLight{picture, vec3(up), static_cast<float>(turn_rad)};
  l.color = vec3(color);
  l.intensity = static_cast<float>(intensity);
  l.of_camera = of_camera;
  check_lights({&l, 1});
  return l;
}

/// (H, 2 H, 3) of float32 in C order, linear light.
Environment environment_of_array(const Array& array) {
  if (array.ndim() != 3 || array.shape(2) != 3 || array.dtype() != nb::dtype<float>() ||
      array.stride(2) != 1 || array.stride(1) != 3 || array.stride(0) % 3 != 0 ||
      array.shape(0) > static_cast<std::size_t>(kMaxImageSize) ||
      array.shape(1) > static_cast<std::size_t>(kMaxImageSize))
    throw Error(Errc::invalid_argument, "environment: must be (H, 2 H, 3) of float32");
  const ImageView<const Vec3> picture{
      static_cast<const Vec3*>(array.data()), static_cast<int>(array.shape(1)),
      static_cast<int>(array.shape(0)), static_cast<std::ptrdiff_t>(array.stride(0) / 3)};
  const nb::gil_scoped_release released;
  return Environment(picture);
}

Environment environment_of_file(const std::string& file) {
  const nb::gil_scoped_release released;
  if (file == "sky") return Environment(builtin_environment(BuiltinEnvironment::sky));
  if (file == "room") return Environment(builtin_environment(BuiltinEnvironment::room));
  const Image<Vec3> picture = io::read_light(file);
  try {
    return Environment(picture);
  } catch (const Error& e) {
    throw Error(e.code(), file + ": " + e.what());
  }
}

}  // namespace

void bind_lights(nb::module_& m) {
  using nb::arg;
  m.def("linear_from_srgb", linear_from_srgb, arg("display"));
  nb::class_<Environment>(m, "Environment");
  m.def("environment_of_array", environment_of_array, arg("picture"));
  m.def("environment_of_file", environment_of_file, arg("file"));
  nb::class_<Light>(m, "Light").def_prop_ro("throws_shadows", [](const Light& l) {
    return l.casts_shadows && (std::holds_alternative<DirectionalLight>(l.kind) ||
                               std::holds_alternative<SpotLight>(l.kind));
  });
  m.def("light", light, arg("kind"), arg("place"), arg("direction"), arg("below"), arg("range"),
        arg("inner"), arg("outer"), arg("color"), arg("intensity"), arg("of_camera"),
        arg("casts_shadows"), arg("classic").none());
  m.def("headlight", [] { return headlight(); });
  m.def("light_kit", [] { return light_kit(); });
  m.def("environment", environment, arg("picture"), arg("up"), arg("turn"), arg("color"),
        arg("intensity"), arg("of_camera"));
}

}  // namespace rastrum::python
