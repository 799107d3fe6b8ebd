// SPDX-License-Identifier: BSD-3-Clause
// One mesh in many memory layouts.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <list>
#include <string>
#include <vector>

#include <rastrum/mesh.hpp>

#include "tests/support/pixels.hpp"
#include "tests/support/scenes.hpp"

namespace rastrum::test {

/// A wavy sheet of n × n quads with normals, texture coordinates, colours in 255ths, and two
/// materials. `indices` are its quads as triangles.
struct Sheet {
  int n;
  std::vector<Vec3> positions, normals;
  std::vector<Vec2> texcoords;
  std::vector<Vec4> colors;
  std::vector<std::uint8_t> colors8;
  std::vector<std::uint32_t> quads, indices, quad_materials, triangle_materials;

  explicit Sheet(int size) : n(size) {
    for (const auto& [x, y] : pixels(n + 1, n + 1)) {
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
    for_each_cell(n, n, 0, [&](auto a, auto b, auto c, auto d) {
      quads.insert(quads.end(), {a, b, d, c});
      indices.insert(indices.end(), {a, b, d, a, d, c});
      const auto quad = static_cast<std::uint32_t>(quad_materials.size()),
                 side = static_cast<std::uint32_t>(n);
      const std::uint32_t m = (quad % side + quad / side) % 2;
      quad_materials.push_back(m);
      triangle_materials.insert(triangle_materials.end(), {m, m});
    });
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

/// Memory of a layout: bytes at odd addresses.
class Memory {
 public:
  /// Stores `count` values of `bytes` bytes, every `stride` bytes, after `offset` bytes. A negative
  /// stride begins at the end. Returns where the first one is.
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
  /// The same as a view.
  template <class T, class C>
  ArrayView<T> view(const C* values, std::size_t count, std::ptrdiff_t stride,
                    std::size_t offset = 0) {
    constexpr int kChannels = sizeof(T) / sizeof(float);
    return ArrayView<T>::of(put(values, kChannels, count, stride, offset), count, stride);
  }
  template <class C>
  IndexView indices(const std::vector<std::uint32_t>& from, std::ptrdiff_t stride = sizeof(C),
                    std::size_t offset = 0) {
    const std::vector<C> values(from.begin(), from.end());
    return IndexView::of(put(values.data(), 1, values.size(), stride, offset), values.size(),
                         stride);
  }

 private:
  std::list<std::vector<std::byte>> bytes_;
};

/// A layout of a sheet whose picture must equal Sheet::view()'s.
struct Layout {
  std::string name;
  std::function<void(const Sheet&, Memory&, MeshView&)> change;

  [[nodiscard]] MeshView view(const Sheet& sheet, Memory& memory) const {
    MeshView v = sheet.view();
    change(sheet, memory, v);
    return v;
  }
};

namespace layouts_detail {

template <class C>
Layout indices_of(const char* name, std::ptrdiff_t stride = sizeof(C), std::size_t offset = 0) {
  return {std::string("indices ") + name, [=](const Sheet& s, Memory& m, MeshView& v) {
            v.indices = m.indices<C>(s.indices, stride, offset);
            v.face_materials = m.indices<C>(s.triangle_materials, stride, offset);
          }};
}

/// `with_lines` adds faces of two corners, which have no triangle.
template <class C>
Layout polygons(const char* name, bool with_lines) {
  return {name, [=](const Sheet& s, Memory& m, MeshView& v) {
            std::vector<std::uint32_t> corners, offsets{0}, materials;
            const auto end_face = [&](std::uint32_t material) {
              offsets.push_back(static_cast<std::uint32_t>(corners.size()));
              materials.push_back(material);
            };
            for (std::size_t q = 0; q < s.quads.size() / 4; ++q) {
              if (with_lines && q % 3 == 0) {
                corners.insert(corners.end(), {s.quads[4 * q], 0});
                end_face(0);
              }
              for (std::size_t c = 0; c < 4; ++c) corners.push_back(s.quads[4 * q + c]);
              end_face(s.quad_materials[q]);
            }
            v.indices = m.indices<C>(corners);
            v.faces = {FaceKind::polygons, m.indices<C>(offsets)};
            v.face_materials = m.indices<std::uint32_t>(materials);
          }};
}

inline std::vector<double> wide(const std::vector<Vec3>& from) {
  std::vector<double> all;
  for (const Vec3& p : from) all.insert(all.end(), {p.x, p.y, p.z});
  return all;
}

}  // namespace layouts_detail

/// Layouts whose pictures and ids equal the packed one's bit for bit.
inline std::vector<Layout> layouts() {
  using namespace layouts_detail;
  std::vector<Layout> all{indices_of<std::uint16_t>("uint16"),
                          indices_of<std::int16_t>("int16"),
                          indices_of<std::int32_t>("int32"),
                          indices_of<std::uint32_t>("uint32 with a stride", 12, 1),
                          indices_of<std::int64_t>("int64"),
                          indices_of<std::uint64_t>("uint64 backwards", -8),
                          polygons<std::int64_t>("polygons, int64", false),
                          polygons<std::int32_t>("polygons and lines, int32", true),
                          polygons<std::uint16_t>("polygons, uint16", true)};
  const auto add = [&](const char* name, auto change) { all.push_back({name, change}); };
  add("positions interleaved, unaligned", [](const Sheet& s, Memory& m, MeshView& v) {
    v.positions = m.view<Vec3>(&s.positions[0].x, s.positions.size(), 17, 3);
  });
  add("positions and normals backwards", [](const Sheet& s, Memory& m, MeshView& v) {
    const std::size_t n = s.positions.size();
    v.positions = m.view<Vec3>(&s.positions[0].x, n, -12);
    v.normals.values = m.view<Vec3>(&s.normals[0].x, n, -20);
  });
  add("float64 attributes", [](const Sheet& s, Memory& m, MeshView& v) {
    std::vector<double> texcoords, colors;
    for (const Vec2& p : s.texcoords) texcoords.insert(texcoords.end(), {p.x, p.y});
    for (const Vec4& p : s.colors) colors.insert(colors.end(), {p.x, p.y, p.z, p.w});
    const std::size_t n = s.normals.size();
    v.normals.values = m.view<Vec3>(wide(s.normals).data(), n, 24);
    v.texcoords.values = m.view<Vec2>(texcoords.data(), n, 16);
    v.colors.values = m.view<Vec4>(colors.data(), n, 40);
  });
  add("RGBA8", [](const Sheet& s, Memory& m, MeshView& v) {
    v.colors.values = m.view<Vec4>(s.colors8.data(), s.colors.size(), 4);
  });
  add("quads", [](const Sheet& s, Memory& m, MeshView& v) {
    v.faces.kind = FaceKind::quads;
    v.indices = m.indices<std::int64_t>(s.quads);
    v.face_materials = s.quad_materials;
  });
  add("attributes of corners", [](const Sheet& s, Memory& m, MeshView& v) {
    std::vector<Vec3> normals;
    std::vector<Vec4> colors;
    for (const std::uint32_t i : s.indices) {
      normals.push_back(s.normals[i]);
      colors.push_back(s.colors[i]);
    }
    const std::size_t n = normals.size();
    v.normals = {m.view<Vec3>(&normals[0].x, n, 12), {}, Per::corner};
    v.colors = {m.view<Vec4>(&colors[0].x, n, 16), {}, Per::corner};
  });
  add("attributes by indices of int64", [](const Sheet& s, Memory& m, MeshView& v) {
    v.normals.indices = m.indices<std::int64_t>(s.indices);
    v.colors.indices = m.indices<std::int32_t>(s.indices);
  });
  return all;
}

}  // namespace rastrum::test
