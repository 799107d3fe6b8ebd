// One glTF primitive as a mesh: its accessors, its triangles (lists, strips, fans).
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <string>
#include <utility>

#include <rastrum/io/gltf_internal.hpp>

namespace rastrum::io::gltf {
namespace {

/// The accessor of an attribute as vectors of N floats; `count` elements are expected.
template <class T>
std::vector<T> read_attribute(const Json& accessor, Buffers& buffers, std::size_t count) {
  constexpr std::size_t kComponents = sizeof(T) / sizeof(float);
  const std::size_t has = accessor_type(accessor).components;
  const bool is_color = kComponents == 4;
  if (has != kComponents && !(is_color && has == 3))
    accessor.fail("has the wrong type for its attribute");
  if (accessor["count"].count() != count)
    accessor.fail("has " + std::to_string(accessor["count"].count()) +
                  " elements, but the primitive has " + std::to_string(count) + " vertices");
  const std::vector<float> floats = buffers.floats(accessor);
  std::vector<T> values(count);
  if (has == kComponents) {
    std::memcpy(static_cast<void*>(values.data()), floats.data(), count * sizeof(T));
  } else {
    for (std::size_t i = 0; i < count; ++i) {
      const float rgba[4] = {floats[3 * i], floats[3 * i + 1], floats[3 * i + 2], 1};
      std::memcpy(static_cast<void*>(&values[i]), rgba, sizeof(T));
    }
  }
  return values;
}

void apply(const TextureUse& use, std::vector<Vec2>& texcoords) {
  const auto& m = use.m;
  for (Vec2& t : texcoords)
    t = {m[0][0] * t.x + m[0][1] * t.y + m[0][2], m[1][0] * t.x + m[1][1] * t.y + m[1][2]};
}

/// Corners in drawing order to triangles; strips turn every second one.
std::vector<std::uint32_t> triangles_of(const std::vector<std::uint32_t>& corners, bool strip) {
  std::vector<std::uint32_t> r;
  if (corners.size() < 3) return r;
  r.reserve((corners.size() - 2) * 3);
  for (std::size_t i = 0; i + 2 < corners.size(); ++i) {
    const std::size_t odd = strip ? i % 2 : 0;
    r.push_back(strip ? corners[i] : corners[0]);
    r.push_back(corners[i + 1 + odd]);
    r.push_back(corners[i + 2 - odd]);
  }
  return r;
}

}  // namespace

std::optional<Mesh> read_primitive(const Json& primitive, const Json& document, Buffers& buffers,
                                   const TextureUse& use, std::vector<std::string>& warnings) {
  const Json attributes = primitive["attributes"];
  const auto position = attributes.get("POSITION");
  if (!position) {
    warnings.push_back(primitive.path() + " has no positions; it is left out");
    return std::nullopt;
  }
  const Json accessors = document["accessors"];
  const Json position_accessor = accessors.at(position->count());
  const std::size_t count = position_accessor["count"].count();
  const auto index_member = primitive.get("indices");
  const std::size_t mode = primitive.count("mode", 4);
  if (mode < 4) {
    const std::size_t n =
        index_member ? accessors.at(index_member->count())["count"].count() : count;
    warnings.push_back(primitive.path() + " holds " + (mode == 0 ? "points" : "lines") + " (" +
                       std::to_string(n) + " indices); they are left out");
    return std::nullopt;
  }

  Mesh mesh;
  mesh.positions = read_attribute<Vec3>(position_accessor, buffers, count);
  if (const auto a = attributes.get("NORMAL"))
    mesh.normals.values = read_attribute<Vec3>(accessors.at(a->count()), buffers, count);
  if (const auto a = attributes.get("COLOR_0"))
    mesh.colors.values = read_attribute<Vec4>(accessors.at(a->count()), buffers, count);
  const std::string set = "TEXCOORD_" + std::to_string(use.set);
  if (const auto a = attributes.get(set.c_str())) {
    mesh.texcoords.values = read_attribute<Vec2>(accessors.at(a->count()), buffers, count);
    if (use != TextureUse{use.set}) apply(use, mesh.texcoords.values);
  }
  if (primitive.get("targets"))
    warnings.push_back(primitive.path() + " has morph targets; its base shape is drawn");

  if (index_member) {
    mesh.indices = buffers.indices(accessors.at(index_member->count()));
    for (const std::uint32_t i : mesh.indices)
      if (i >= count)
        index_member->fail("refers to vertex " + std::to_string(i) + " of " +
                           std::to_string(count));
  }
  const std::size_t corners = index_member ? mesh.indices.size() : count;
  if (corners < 3 || (mode == 4 && corners % 3 != 0))
    warnings.push_back(primitive.path() + " has " + std::to_string(corners) +
                       " indices, which do not make up whole triangles");
  if (mode > 4) {
    if (!index_member) {
      mesh.indices.resize(count);
      for (std::size_t i = 0; i < count; ++i) mesh.indices[i] = static_cast<std::uint32_t>(i);
    }
    mesh.indices = triangles_of(mesh.indices, mode == 5);
    if (mesh.indices.empty()) return std::nullopt;
  } else {
    if (corners < 3) return std::nullopt;
    mesh.indices.resize(mesh.indices.size() / 3 * 3);
  }
  return mesh;
}

}  // namespace rastrum::io::gltf
