// SPDX-License-Identifier: BSD-3-Clause
#include "flatten.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <utility>
#include <variant>

#include <rastrum/error.hpp>
#include <rastrum/raster/rules/clip.hpp>

namespace rastrum::cli {
namespace {

Vec3d transform_position(const Mat4d& a, Vec3d p) {
  const raster::Vec4d q = raster::transform_point(a, p);
  return {q.x, q.y, q.z};
}

/// By the cofactors of the linear part: the inverse transpose times the determinant, without a
/// division. A mirror keeps the normals' side, because it turns the winding.
Vec3 transform_normal(const Mat4d& a, Vec3 n) {
  const auto cofactor = [&](int i, int j) {
    const int r0 = (i + 1) % 3, r1 = (i + 2) % 3, c0 = (j + 1) % 3, c1 = (j + 2) % 3;
    return a.m[r0][c0] * a.m[r1][c1] - a.m[r0][c1] * a.m[r1][c0];
  };
  const auto row = [&](int i) {
    return static_cast<float>(cofactor(i, 0) * n.x + cofactor(i, 1) * n.y + cofactor(i, 2) * n.z);
  };
  return normalize(Vec3{row(0), row(1), row(2)});
}

bool is_identity(const Mat4d& a) {
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j)
      if (a.m[i][j] != (i == j ? 1 : 0)) return false;
  return true;
}

template <class G>
void place(G& geometry, std::vector<Vec3>& normals, const Mat4d& a) {
  if (is_identity(a)) return;
  for (Vec3& p : geometry.positions) p = static_cast<Vec3>(transform_position(a, p));
  for (Vec3d& p : geometry.wide_positions) p = transform_position(a, p);
  for (Vec3& n : normals) n = transform_normal(a, n);
}

/// In float64 if one of the two has such positions.
template <class G>
void join_positions(G& into, const G& from) {
  if (!into.wide_positions.empty() || !from.wide_positions.empty()) {
    if (into.wide_positions.empty())
      into.wide_positions.assign(into.positions.begin(), into.positions.end());
    if (from.wide_positions.empty())
      into.wide_positions.insert(into.wide_positions.end(), from.positions.begin(),
                                 from.positions.end());
    else
      into.wide_positions.insert(into.wide_positions.end(), from.wide_positions.begin(),
                                 from.wide_positions.end());
  }
  into.positions.insert(into.positions.end(), from.positions.begin(), from.positions.end());
}

/// Keeps the scalars if both have the same names. Returns whether any are lost.
bool join_scalars(std::vector<NamedScalars>& into, const std::vector<NamedScalars>& from) {
  const bool same = std::ranges::equal(
      into, from, [](const auto& a, const auto& b) { return a.name == b.name && a.per == b.per; });
  if (!same) {
    into.clear();
    return true;
  }
  for (std::size_t i = 0; i < into.size(); ++i)
    into[i].values.insert(into[i].values.end(), from[i].values.begin(), from[i].values.end());
  return false;
}

struct Kept {
  bool normals = true, texcoords = true, colors = true, scalars = true;
};

/// Keeps the attributes that all clouds have.
Points joined(const std::vector<Points>& clouds, Kept& whole) {
  Points all;
  const auto have = [&](auto member) {
    return std::ranges::none_of(clouds, [&](const Points& p) { return (p.*member).empty(); });
  };
  const auto join = [&](auto member) {
    for (const Points& p : clouds)
      (all.*member).insert((all.*member).end(), (p.*member).begin(), (p.*member).end());
  };
  for (const Points& p : clouds) join_positions(all, p);
  if (have(&Points::normals)) join(&Points::normals);
  if (have(&Points::colors)) join(&Points::colors);
  if (!clouds.empty()) all.scalars = clouds.front().scalars;
  for (std::size_t i = 1; i < clouds.size(); ++i)
    whole.scalars &= !join_scalars(all.scalars, clouds[i].scalars);
  return all;
}

/// Drops an attribute that the positions' indices cannot reach, or that earlier meshes lack.
/// `kept`: whether the result has it so far.
template <class T>
void join(Attribute<T>& into, Attribute<T>& from, std::size_t positions, bool& kept, bool& lost) {
  const bool usable = from.indices.empty() && from.values.size() >= positions;
  lost |= !from.empty() && (!usable || !kept);
  kept = kept && usable && positions != 0;
  if (!kept) {
    lost |= !into.empty();
    into = {};
    return;
  }
  into.values.insert(into.values.end(), from.values.begin(),
                     from.values.begin() + static_cast<std::ptrdiff_t>(positions));
}

void append(Mesh& into, Mesh& from, Kept& kept, Kept& whole) {
  const std::size_t first = into.positions.size();
  const std::size_t count = from.positions.size();
  if (first + count > std::numeric_limits<std::uint32_t>::max())
    throw Error(Errc::unsupported, "the scene has more vertices than one mesh can number");
  join_positions(into, from);
  const std::size_t corners = from.triangle_count() * 3;
  into.indices.reserve(into.indices.size() + corners);
  for (std::size_t i = 0; i < corners; ++i)
    into.indices.push_back(static_cast<std::uint32_t>(first) + (from.indices.empty()
                                                                    ? static_cast<std::uint32_t>(i)
                                                                    : from.indices[i]));
  bool lost[3] = {};
  join(into.normals, from.normals, count, kept.normals, lost[0]);
  join(into.texcoords, from.texcoords, count, kept.texcoords, lost[1]);
  join(into.colors, from.colors, count, kept.colors, lost[2]);
  whole.normals &= !lost[0];
  whole.texcoords &= !lost[1];
  whole.colors &= !lost[2];
  if (first == 0)
    into.scalars = from.scalars;
  else
    whole.scalars &= !join_scalars(into.scalars, from.scalars);
}

}  // namespace

Flattened flatten(Scene scene) {
  Flattened flat{{}, {}, std::move(scene.warnings)};
  Kept kept, whole;
  std::vector<Points> clouds;
  bool lines = false, surfaces = false;
  for (const Instance& instance : scene.instances) {
    if (instance.geometry) {
      const Geometry& geometry = scene.geometries[*instance.geometry];
      lines |= std::holds_alternative<Lines>(geometry);
      if (const auto* const points = std::get_if<Points>(&geometry)) {
        clouds.push_back(*points);
        place(clouds.back(), clouds.back().normals, instance.object_to_world);
      } else {
        surfaces |= !std::holds_alternative<Lines>(geometry);
      }
      continue;
    }
    Mesh mesh = scene.meshes[instance.mesh];
    place(mesh, mesh.normals.values, instance.object_to_world);
    append(flat.mesh, mesh, kept, whole);
  }
  const auto tell = [&](bool all, const char* what) {
    if (!all)
      flat.warnings.push_back(std::string("the ") + what +
                              " are left out: some mesh has none, or has them numbered apart from "
                              "the positions, which PLY cannot say");
  };
  if (lines) flat.warnings.emplace_back("the lines are left out: PLY has none");
  if (surfaces)
    flat.warnings.emplace_back(
        "the spheres, cylinders, tubes and discs are left out: PLY has none");
  if (!clouds.empty() && flat.mesh.triangle_count() != 0)
    flat.warnings.emplace_back("the points are left out: a PLY file with faces has none");
  else
    flat.points = joined(clouds, whole);
  tell(whole.normals, "normals");
  tell(whole.texcoords, "texture coordinates");
  tell(whole.colors, "colours");
  if (!whole.scalars)
    flat.warnings.emplace_back("the scalars are left out: not all parts have the same ones");
  if (!scene.materials.empty())
    flat.warnings.emplace_back("the materials are left out: PLY has none");
  return flat;
}

}  // namespace rastrum::cli
