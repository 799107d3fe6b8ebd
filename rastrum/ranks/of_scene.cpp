// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/ranks/of_scene.hpp>

#include <algorithm>
#include <cstring>
#include <limits>
#include <type_traits>
#include <variant>

#include <rastrum/core/float_scope.hpp>
#include <rastrum/error.hpp>
#include <rastrum/ranks/blocks.hpp>
#include <rastrum/scene/fit_ranks.hpp>

namespace rastrum::ranks {
namespace {

/// A light as bytes: the common fields, its kind, that kind's fields.
void put_light(Bytes& to, const Light& light) {
  put(to, light.color);
  put(to, light.intensity);
  put(to, light.of_camera);
  put(to, light.kind.index());
  std::visit(
      [&](const auto& kind) {
        if constexpr (std::is_same_v<std::remove_cvref_t<decltype(kind)>, EnvironmentLight>)
          throw Error(Errc::unsupported, "the lights of ranks: an environment is not sent");
        else
          put(to, kind);
      },
      light.kind);
}

Light take_light(Reader& from) {
  Light light;
  light.color = from.take<Vec3>();
  light.intensity = from.take<float>();
  light.of_camera = from.take<bool>();
  switch (from.take<std::size_t>()) {
    case 0:
      light.kind = from.take<AmbientLight>();
      break;
    case 1:
      light.kind = from.take<HemisphereLight>();
      break;
    case 2:
      light.kind = from.take<DirectionalLight>();
      break;
    case 3:
      light.kind = from.take<PointLight>();
      break;
    default:
      light.kind = from.take<SpotLight>();
  }
  return light;
}

}  // namespace

std::vector<ScalarMapping> mappings_of(Communicator& ranks, const AtPhase& at,
                                       const SceneView& scene) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::vector<ScalarMapping> mappings;
  std::vector<ScalarRange> in_use;  // by mapping
  in_phase(ranks, at, "look at numbers", [&] {
    mappings.assign(scene.scalar_mappings.begin(), scene.scalar_mappings.end());
    for (std::size_t m = 0; m < mappings.size(); ++m)
      in_use.push_back(takes_range(mappings[m]) ? scalars_in_use(scene, m)
                                                : ScalarRange{kInfinity, -kInfinity});
  });
  const auto all = gather_to_all(ranks, std::as_bytes(std::span(in_use)));
  in_phase(ranks, at, "agree on ranges", [&] {
    for (const auto& bytes : all) {
      std::vector<ScalarRange> of_rank(bytes.size() / sizeof(ScalarRange));
      if (!bytes.empty()) std::memcpy(of_rank.data(), bytes.data(), bytes.size());
      for (std::size_t m = 0; m < std::min(of_rank.size(), in_use.size()); ++m) {
        in_use[m].low = std::min(in_use[m].low, of_rank[m].low);
        in_use[m].high = std::max(in_use[m].high, of_rank[m].high);
      }
    }
    for (std::size_t m = 0; m < mappings.size(); ++m)
      if (takes_range(mappings[m])) mappings[m].range = range_of(mappings[m], in_use[m]);
  });
  return mappings;
}

}  // namespace rastrum::ranks

namespace rastrum {

std::vector<ScalarMapping> mappings_of_ranks(Communicator& ranks, const SceneView& scene) {
  const FloatScope floats;
  return rastrum::ranks::mappings_of(ranks, {}, scene);
}

Bounds bounds_of_ranks(Communicator& ranks, const SceneView& scene) {
  const FloatScope floats;
  Bounds own;
  do_alike(ranks, "look for the box", [&] { own = bounds(scene); });
  Box3d box;
  if (own.vertices_in_use != 0) box = {own.min, own.max};
  FitOfRanks fit(ranks);
  gather_boxes(&fit, box);
  const double count = static_cast<double>(own.vertices_in_use);
  double vertices = 0;
  for (const double of_rank : fit.gather(std::span(&count, 1))) vertices += of_rank;
  if (vertices == 0) return {};
  return {box.min, box.max, static_cast<decltype(own.vertices_in_use)>(vertices)};
}

std::vector<Light> lights_of_ranks(Communicator& ranks, std::span<const Light> own) {
  rastrum::ranks::Bytes bytes;
  do_alike(ranks, "pack lights", [&] {
    for (const Light& light : own) rastrum::ranks::put_light(bytes, light);
  });
  const auto all = gather_to_all(ranks, bytes);
  std::vector<Light> lights;
  do_alike(ranks, "take lights", [&] {
    for (const auto& of_rank : all)
      for (rastrum::ranks::Reader from(of_rank); !from.at_end();)
        lights.push_back(rastrum::ranks::take_light(from));
  });
  return lights;
}

std::vector<Camera> cameras_of_ranks(Communicator& ranks, std::span<const Camera> own) {
  static_assert(std::is_trivially_copyable_v<Camera>);
  const auto all = gather_to_all(ranks, std::as_bytes(own));
  std::vector<Camera> cameras;
  do_alike(ranks, "take cameras", [&] {
    for (const auto& of_rank : all) {
      const std::size_t before = cameras.size();
      cameras.resize(before + of_rank.size() / sizeof(Camera));
      if (!of_rank.empty()) std::memcpy(cameras.data() + before, of_rank.data(), of_rank.size());
    }
  });
  return cameras;
}

}  // namespace rastrum
