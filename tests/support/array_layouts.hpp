// One mesh in many memories: the arrays that a test's layouts view, which lie here.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <list>
#include <string>
#include <vector>

#include <rastrum/mesh.hpp>

namespace rastrum::test {

/// A wavy sheet of n × n quads with normals, texture coordinates, colours of whole 255ths, and two
/// materials of its faces. `indices` are its quads as triangles.
struct Sheet {
  int n;
  std::vector<Vec3> positions, normals;
  std::vector<Vec2> texcoords;
  std::vector<Vec4> colors;
  std::vector<std::uint8_t> colors8;
  std::vector<std::uint32_t> quads, indices, quad_materials, triangle_materials;

  explicit Sheet(int size) : n(size) {
    for (int y = 0; y <= n; ++y)
      for (int x = 0; x <= n; ++x) {
        const float u = static_cast<float>(x) / static_cast<float>(n),
                    v = static_cast<float>(y) / static_cast<float>(n);
        positions.push_back({2 * u - 1, 2 * v - 1, 0.4F * u * v - 0.3F * v * (1 - u * u)});
        normals.push_back({0.3F * v - 0.5F * u, 0.25F - u * v, 1});
        texcoords.push_back({u, 1 - v});
        const int c[4] = {x * 255 / n, y * 255 / n, (x * 7 + y * 3) % 256, 255 - (x * y) % 60};
        for (const int i : c) colors8.push_back(static_cast<std::uint8_t>(i));
        const auto part = [](int i) { return static_cast<float>(i) / 255.0F; };
        colors.push_back({part(c[0]), part(c[1]), part(c[2]), part(c[3])});
      }
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x) {
        const auto at = [&](int i, int j) {
          return static_cast<std::uint32_t>((y + j) * (n + 1) + x + i);
        };
        const std::uint32_t q[4] = {at(0, 0), at(1, 0), at(1, 1), at(0, 1)};
        quads.insert(quads.end(), q, q + 4);
        indices.insert(indices.end(), {q[0], q[1], q[2], q[0], q[2], q[3]});
        const auto m = static_cast<std::uint32_t>((x + y) % 2);
        quad_materials.push_back(m);
        triangle_materials.insert(triangle_materials.end(), {m, m});
      }
  }

  [[nodiscard]] MeshView view() const {
    MeshView v{.positions = positions, .indices = indices};
    v.normals.values = normals;
    v.texcoords.values = texcoords;
    v.colors.values = colors;
    v.face_materials = triangle_materials;
    return v;
  }
};

/// Memory of a layout: bytes that start at no round address.
class Memory {
 public:
  /// `count` values of `bytes` bytes, every `stride` bytes, behind `offset` bytes; a negative
  /// stride begins at the end. Returns where the first lies.
  template <class C>
  const C* put(const C* values, int channels, std::size_t count, std::ptrdiff_t stride,
               std::size_t offset = 0) {
    const auto step = static_cast<std::size_t>(stride < 0 ? -stride : stride);
    const std::size_t value = sizeof(C) * static_cast<std::size_t>(channels);
    std::vector<std::byte>& to = bytes_.emplace_back(
        offset + (count == 0 ? 0 : step * (count - 1)) + value, std::byte{0xA5});
    std::byte* const first = to.data() + offset + (stride < 0 ? step * (count - 1) : 0);
    for (std::size_t i = 0; i < count; ++i)
      std::memcpy(first + static_cast<std::ptrdiff_t>(i) * stride,
                  values + i * static_cast<std::size_t>(channels), value);
    return static_cast<const C*>(static_cast<const void*>(first));
  }
  template <class C, class From>
  const C* convert(const std::vector<From>& values) {
    std::vector<C> other(values.begin(), values.end());
    return put(other.data(), 1, other.size(), sizeof(C));
  }

 private:
  std::list<std::vector<std::byte>> bytes_;
};

/// A layout of a sheet that must give the picture of Sheet::view().
struct Layout {
  std::string name;
  std::function<MeshView(const Sheet&, Memory&)> view;
};

namespace layouts_detail {

template <class C>
Layout indices_of(const char* name, std::ptrdiff_t stride = sizeof(C), std::size_t offset = 0) {
  return {
      std::string("indices ") + name, [=](const Sheet& s, Memory& m) {
        MeshView v = s.view();
        const std::vector<C> wide(s.indices.begin(), s.indices.end());
        v.indices =
            IndexView::of(m.put(wide.data(), 1, wide.size(), stride, offset), wide.size(), stride);
        const std::vector<C> materials(s.triangle_materials.begin(), s.triangle_materials.end());
        v.face_materials = IndexView::of(
            m.put(materials.data(), 1, materials.size(), stride, offset), materials.size(), stride);
        return v;
      }};
}

template <class C>
MeshView polygons(const Sheet& s, Memory& m, bool with_lines) {
  MeshView v = s.view();
  std::vector<C> corners, offsets{0};
  std::vector<std::uint32_t> materials;
  for (std::size_t q = 0; q < s.quads.size() / 4; ++q) {
    // Faces of two corners, which have no triangle, between some.
    if (with_lines && q % 3 == 0) {
      corners.insert(corners.end(), {static_cast<C>(s.quads[4 * q]), 0});
      offsets.push_back(static_cast<C>(corners.size()));
      materials.push_back(0);
    }
    for (std::size_t c = 0; c < 4; ++c) corners.push_back(static_cast<C>(s.quads[4 * q + c]));
    offsets.push_back(static_cast<C>(corners.size()));
    materials.push_back(s.quad_materials[q]);
  }
  v.indices = IndexView::of(m.put(corners.data(), 1, corners.size(), sizeof(C)), corners.size());
  v.faces = {FaceKind::polygons,
             IndexView::of(m.put(offsets.data(), 1, offsets.size(), sizeof(C)), offsets.size())};
  v.face_materials =
      IndexView::of(m.put(materials.data(), 1, materials.size(), 4), materials.size());
  return v;
}

}  // namespace layouts_detail

/// Layouts whose pictures have the bits of the packed one, ids too.
inline std::vector<Layout> layouts() {
  using namespace layouts_detail;
  std::vector<Layout> all;
  all.push_back({"positions interleaved, unaligned", [](const Sheet& s, Memory& m) {
                   MeshView v = s.view();
                   v.positions =
                       ArrayView<Vec3>::of(m.put(&s.positions[0].x, 3, s.positions.size(), 17, 3),
                                           s.positions.size(), 17);
                   return v;
                 }});
  all.push_back({"positions and normals backwards", [](const Sheet& s, Memory& m) {
                   MeshView v = s.view();
                   const std::size_t n = s.positions.size();
                   v.positions = ArrayView<Vec3>::of(m.put(&s.positions[0].x, 3, n, -12), n, -12);
                   v.normals.values =
                       ArrayView<Vec3>::of(m.put(&s.normals[0].x, 3, n, -20), n, -20);
                   return v;
                 }});
  all.push_back(indices_of<std::uint16_t>("uint16"));
  all.push_back(indices_of<std::int16_t>("int16"));
  all.push_back(indices_of<std::int32_t>("int32"));
  all.push_back(indices_of<std::uint32_t>("uint32 with a stride", 12, 1));
  all.push_back(indices_of<std::int64_t>("int64"));
  all.push_back(indices_of<std::uint64_t>("uint64 backwards", -8));
  all.push_back({"float64 attributes", [](const Sheet& s, Memory& m) {
                   MeshView v = s.view();
                   std::vector<double> normals, texcoords, colors;
                   for (const Vec3& p : s.normals) normals.insert(normals.end(), {p.x, p.y, p.z});
                   for (const Vec2& p : s.texcoords) texcoords.insert(texcoords.end(), {p.x, p.y});
                   for (const Vec4& p : s.colors) colors.insert(colors.end(), {p.x, p.y, p.z, p.w});
                   const std::size_t n = s.normals.size();
                   v.normals.values = ArrayView<Vec3>::of(m.put(normals.data(), 3, n, 24), n);
                   v.texcoords.values = ArrayView<Vec2>::of(m.put(texcoords.data(), 2, n, 16), n);
                   v.colors.values = ArrayView<Vec4>::of(m.put(colors.data(), 4, n, 40), n, 40);
                   return v;
                 }});
  all.push_back({"RGBA8", [](const Sheet& s, Memory& m) {
                   MeshView v = s.view();
                   v.colors.values = ArrayView<Vec4>::of(
                       m.put(s.colors8.data(), 4, s.colors.size(), 4), s.colors.size());
                   return v;
                 }});
  all.push_back({"quads", [](const Sheet& s, Memory& m) {
                   MeshView v = s.view();
                   v.faces.kind = FaceKind::quads;
                   v.indices = IndexView::of(m.convert<std::int64_t>(s.quads), s.quads.size());
                   v.face_materials = s.quad_materials;
                   return v;
                 }});
  all.push_back({"polygons, int64",
                 [](const Sheet& s, Memory& m) { return polygons<std::int64_t>(s, m, false); }});
  all.push_back({"polygons and lines, int32",
                 [](const Sheet& s, Memory& m) { return polygons<std::int32_t>(s, m, true); }});
  all.push_back({"polygons, uint16",
                 [](const Sheet& s, Memory& m) { return polygons<std::uint16_t>(s, m, true); }});
  all.push_back(
      {"attributes of corners", [](const Sheet& s, Memory& m) {
         MeshView v = s.view();
         std::vector<Vec3> normals;
         std::vector<Vec4> colors;
         for (const std::uint32_t i : s.indices) {
           normals.push_back(s.normals[i]);
           colors.push_back(s.colors[i]);
         }
         const std::size_t n = normals.size();
         v.normals = {ArrayView<Vec3>::of(m.put(&normals[0].x, 3, n, 12), n), {}, Per::corner};
         v.colors = {ArrayView<Vec4>::of(m.put(&colors[0].x, 4, n, 16), n), {}, Per::corner};
         return v;
       }});
  all.push_back({"attributes by indices of int64", [](const Sheet& s, Memory& m) {
                   MeshView v = s.view();
                   v.normals.indices =
                       IndexView::of(m.convert<std::int64_t>(s.indices), s.indices.size());
                   v.colors.indices =
                       IndexView::of(m.convert<std::int32_t>(s.indices), s.indices.size());
                   return v;
                 }});
  return all;
}

}  // namespace rastrum::test
