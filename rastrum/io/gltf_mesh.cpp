// SPDX-License-Identifier: BSD-3-Clause
// A glTF primitive (list, strip or fan) as a mesh, points or lines.
#include <cstring>
#include <numeric>
#include <string>
#include <utility>

#include <rastrum/io/gltf_internal.hpp>

namespace rastrum::io::gltf {
namespace {

void apply(const TextureUse& use, std::vector<Vec2>& texcoords) {
  const auto& m = use.m;
  for (Vec2& t : texcoords)
    t = {m[0][0] * t.x + m[0][1] * t.y + m[0][2], m[1][0] * t.x + m[1][1] * t.y + m[1][2]};
}

/// Triangles of a strip or fan. A strip turns every second one.
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

std::vector<std::uint32_t> in_order(std::size_t corners) {
  std::vector<std::uint32_t> r(corners);
  std::iota(r.begin(), r.end(), 0U);
  return r;
}

/// Estimated bytes that Draco takes.
constexpr std::uint64_t kDracoVertex = 64, kDracoCorner = 32;

/// Whether the accessors also hold unpacked what an extension has packed.
bool is_whole(const Json& primitive, const Json& accessors) {
  bool whole = true;
  const auto add = [&](const Json& index) {
    const Json a = accessors.at(index.count());
    whole &= a.get("bufferView") || a.get("sparse");
  };
  primitive["attributes"].for_each_member(
      [&](const std::string&, const Json& index) { add(index); });
  if (const auto indices = primitive.get("indices")) add(*indices);
  return whole;
}

}  // namespace

bool has_positions(const Json& primitive, std::vector<std::string>& warnings) {
  if (primitive["attributes"].get("POSITION")) return true;
  warnings.push_back(primitive.path() + " has no positions; it is left out");
  return false;
}

bool is_points_or_lines(const Json& primitive) {
  return primitive.count("mode", 4) < 4;
}

PrimitiveData::PrimitiveData(const Json& primitive, const Json& document, Buffers& buffers)
    : primitive_(primitive), accessors_(document["accessors"]), buffers_(buffers) {
  vertices_ = (*attribute("POSITION"))["count"].count();
  const auto packed = primitive.extension(kDraco);
  if (!packed || (!has_draco() && is_whole(primitive, accessors_))) return;
  const Json view = (*packed)["bufferView"];
  const auto bytes = buffers.view(view.count());
  if (!bytes) view.fail("has no bytes");
  buffers.budget().take(vertices_, kDracoVertex);
  if (const auto indices = primitive.get("indices"))
    buffers.budget().take(accessors_.at(indices->count())["count"].count(), kDracoCorner);
  unpacked_ = decode_draco(primitive, *packed, document, *bytes);
}

std::optional<Json> PrimitiveData::attribute(const std::string& name) const {
  const auto index = primitive_["attributes"].get(name.c_str());
  return index ? std::optional(accessors_.at(index->count())) : std::nullopt;
}

template <class T>
std::vector<T> PrimitiveData::read(const std::string& name) const {
  std::optional<Bytes> packed;
  if (unpacked_)
    if (const auto at = unpacked_->attributes.find(name); at != unpacked_->attributes.end())
      packed = at->second;
  return read<T>(*attribute(name), packed);
}

template <class T>
std::vector<T> PrimitiveData::read(const Json& accessor, std::optional<Bytes> packed) const {
  constexpr std::size_t kComponents = sizeof(T) / sizeof(float);
  const std::size_t has = accessor_type(accessor).components;
  const bool is_rgb = kComponents == 4 && has == 3;
  if (has != kComponents && !is_rgb) accessor.fail("has the wrong type for its attribute");
  if (accessor["count"].count() != vertices_)
    accessor.fail("has " + std::to_string(accessor["count"].count()) +
                  " elements, but the primitive has " + std::to_string(vertices_) + " vertices");
  const std::vector<float> floats = buffers_.floats(accessor, packed);
  std::vector<T> values(vertices_);
  if (has == kComponents)
    std::memcpy(static_cast<void*>(values.data()), floats.data(), vertices_ * sizeof(T));
  else if constexpr (kComponents == 4)
    for (std::size_t i = 0; i < vertices_; ++i)
      values[i] = {floats[3 * i], floats[3 * i + 1], floats[3 * i + 2], 1};
  return values;
}
template std::vector<float> PrimitiveData::read(const std::string&) const;
template std::vector<Vec2> PrimitiveData::read(const std::string&) const;
template std::vector<Vec3> PrimitiveData::read(const std::string&) const;
template std::vector<Vec4> PrimitiveData::read(const std::string&) const;
template std::vector<Vec3> PrimitiveData::read(const Json&, std::optional<Bytes>) const;

std::vector<NamedScalars> PrimitiveData::scalars() const {
  std::vector<NamedScalars> all;
  primitive_["attributes"].for_each_member([&](const std::string& name, const Json&) {
    if (!name.starts_with("_") || accessor_type(*attribute(name)).components != 1) return;
    const std::vector<float> values = read<float>(name);
    all.push_back({name, {values.begin(), values.end()}, Per::vertex});
  });
  return all;
}

std::vector<std::uint32_t> PrimitiveData::indices() const {
  const auto member = primitive_.get("indices");
  if (!member) return {};
  if (unpacked_) buffers_.budget().take(unpacked_->indices.size(), sizeof(std::uint32_t));
  std::vector<std::uint32_t> r =
      unpacked_ ? unpacked_->indices : buffers_.indices(accessors_.at(member->count()));
  for (const std::uint32_t i : r)
    if (i >= vertices_)
      member->fail("refers to vertex " + std::to_string(i) + " of " + std::to_string(vertices_));
  return r;
}

std::optional<Mesh> read_primitive(const Json& primitive, const PrimitiveData& data,
                                   const TextureUse& use, std::vector<std::string>& warnings) {
  Mesh mesh;
  mesh.positions = data.read<Vec3>("POSITION");
  if (data.attribute("NORMAL")) mesh.normals.values = data.read<Vec3>("NORMAL");
  if (data.attribute("COLOR_0")) mesh.colors.values = data.read<Vec4>("COLOR_0");
  mesh.color_space = ColorSpace::linear;
  if (const std::string set = "TEXCOORD_" + std::to_string(use.set); data.attribute(set)) {
    mesh.texcoords.values = data.read<Vec2>(set);
    if (use != TextureUse{use.set}) apply(use, mesh.texcoords.values);
  }
  mesh.scalars = data.scalars();
  mesh.indices = data.indices();
  const std::size_t mode = primitive.count("mode", 4);
  const bool has_indices = primitive.get("indices").has_value();
  const std::size_t corners = has_indices ? mesh.indices.size() : data.vertices();
  if (corners < 3 || (mode == 4 && corners % 3 != 0))
    warnings.push_back(primitive.path() + " has " + std::to_string(corners) +
                       " indices, which do not make up whole triangles");
  if (!has_indices && (mode > 4 || corners % 3 != 0)) {
    data.budget().take(corners, 4 * sizeof(std::uint32_t));
    mesh.indices = in_order(corners);
  }
  if (mode > 4) {
    mesh.indices = triangles_of(mesh.indices, mode == 5);
    if (mesh.indices.empty()) return std::nullopt;
  } else {
    if (corners < 3) return std::nullopt;
    mesh.indices.resize(mesh.indices.size() / 3 * 3);
  }
  return mesh;
}

namespace {

Points read_points(const PrimitiveData& data, const std::vector<std::uint32_t>& corners) {
  data.budget().take(corners.size(), sizeof(Vec3) + sizeof(Vec3) + sizeof(Vec4));
  const auto values = [&](auto all) {
    if (corners.empty()) return all;
    decltype(all) chosen;
    chosen.reserve(corners.size());
    for (const std::uint32_t c : corners) chosen.push_back(all[c]);
    return chosen;
  };
  Points points;
  points.positions = values(data.read<Vec3>("POSITION"));
  if (data.attribute("NORMAL")) points.normals = values(data.read<Vec3>("NORMAL"));
  if (data.attribute("COLOR_0")) points.colors = values(data.read<Vec4>("COLOR_0"));
  points.color_space = ColorSpace::linear;
  points.scalars = data.scalars();
  for (NamedScalars& s : points.scalars) s.values = values(std::move(s.values));
  return points;
}

}  // namespace

std::optional<Geometry> read_points_or_lines(const Json& primitive, const PrimitiveData& data,
                                             std::vector<std::string>& warnings) {
  enum Mode : std::size_t { points, segments, loop, strip };
  const std::size_t mode = primitive.count("mode", 4);
  if (primitive.get("targets"))
    warnings.push_back(primitive.path() +
                       " holds points or lines, whose morph targets are not "
                       "applied");
  std::vector<std::uint32_t> corners = data.indices();
  const bool has_indices = primitive.get("indices").has_value();
  const std::size_t n = has_indices ? corners.size() : data.vertices();
  if (n < (mode == points ? 1U : 2U) || (mode == segments && n % 2 != 0))
    warnings.push_back(primitive.path() + " has " + std::to_string(n) +
                       " indices, which do not make up whole " +
                       (mode == points ? "points" : "lines"));
  if (n < (mode == points ? 1U : 2U)) return std::nullopt;
  if (mode == points) return read_points(data, corners);
  if (!has_indices) {
    data.budget().take(n, sizeof(std::uint32_t));
    corners = in_order(n);
  }
  if (mode == segments) corners.resize(n / 2 * 2);
  if (mode == loop) corners.push_back(corners.front());
  Lines lines;
  lines.kind = mode == segments ? LineKind::segments : LineKind::polylines;
  lines.positions = data.read<Vec3>("POSITION");
  if (data.attribute("COLOR_0")) lines.colors = data.read<Vec4>("COLOR_0");
  lines.color_space = ColorSpace::linear;
  lines.scalars = data.scalars();
  lines.indices = std::move(corners);
  return lines;
}

}  // namespace rastrum::io::gltf
