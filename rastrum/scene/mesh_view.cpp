// SPDX-License-Identifier: BSD-3-Clause
// The faces of a mesh as triangles, and checks of them.
#include <algorithm>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <rastrum/core/enum.hpp>
#include <rastrum/error.hpp>
#include <rastrum/mesh.hpp>
#include <rastrum/scene/face_cuts.hpp>
#include <rastrum/scene/mesh_checks.hpp>

namespace rastrum {
namespace {

struct Run {
  std::uint64_t begin, end;
  [[nodiscard]] std::uint64_t triangles() const { return end - begin < 2 ? 0 : end - begin - 2; }
};

struct Runs {
  const MeshView& mesh;

  [[nodiscard]] std::size_t count() const {
    const std::size_t n = mesh.faces.offsets.size();
    return n == 0 ? mesh.corner_count() != 0 : n - 1;
  }
  [[nodiscard]] Run operator[](std::size_t face) const {
    const IndexView& offsets = mesh.faces.offsets;
    if (offsets.empty()) return {0, mesh.corner_count()};
    return {offsets.wide(face), offsets.wide(face + 1)};
  }
  /// A face has two triangles fewer than corners, so no list of them is kept.
  [[nodiscard]] std::uint64_t first_triangle(std::size_t face) const {
    const IndexView& offsets = mesh.faces.offsets;
    return offsets.empty() ? 0 : offsets.wide(face) - offsets.wide(0) - 2 * face;
  }
  /// The last face that does not begin after the triangle. O(log faces).
  [[nodiscard]] std::size_t face_of(std::uint64_t triangle) const {
    std::size_t low = 0, high = count();
    while (high - low > 1) {
      const std::size_t middle = low + (high - low) / 2;
      (first_triangle(middle) <= triangle ? low : high) = middle;
    }
    return low;
  }
};

/// The triangles of a face that is no fan, from the mesh's cuts or cut here.
class CutFace {
 public:
  /// Null: a fan. Valid until the next call.
  const std::uint32_t* operator()(const MeshView& mesh, std::size_t face, const Run& run) {
    if (mesh.faces.kind != FaceKind::polygons || run.triangles() < 2) return nullptr;
    if (mesh.cuts != nullptr) {
      const std::size_t i = mesh.cuts->find(face);
      return i == FaceCuts::kNone ? nullptr : mesh.cuts->triangles(i);
    }
    if (!cutter_) cutter_.emplace();
    const std::span<const std::uint32_t> cut =
        cutter_->cut(corners_of(mesh, run.begin, run.end, corners_));
    return cut.empty() ? nullptr : cut.data();
  }

 private:
  std::optional<FaceCutter> cutter_;
  std::vector<Vec3d> corners_;
};

/// The triangles of a quad, as places among its corners.
constexpr std::uint8_t kFan[2][3] = {{0, 1, 2}, {0, 2, 3}}, kAcross[2][3] = {{0, 1, 3}, {1, 2, 3}};

/// `vertex`: the vertices of its corners.
const std::uint8_t (&triangles_of_quad(const MeshView& mesh, const std::uint32_t* vertex))[2][3] {
  Vec3d corner[4];
  for (int c = 0; c < 4; ++c) {
    if (vertex[c] >= mesh.positions.size()) return kFan;
    corner[c] = mesh.positions.wide(vertex[c]);
  }
  return is_cut_across(corner) ? kAcross : kFan;
}

void in_order(std::size_t first, std::size_t n, std::uint32_t* out) {
  std::iota(out, out + n, static_cast<std::uint32_t>(first));
}

void read_corners(const MeshView& mesh, std::size_t first, std::size_t n, std::uint32_t* out) {
  if (mesh.indices.empty())
    in_order(first, n, out);
  else
    mesh.indices.read(first, n, out);
}

constexpr std::size_t kCornersAtOnce = 256;

void read_quads(const MeshView& mesh, std::size_t t, std::size_t n, std::uint32_t* out) {
  std::uint32_t corner[kCornersAtOnce];
  for (const std::size_t end = t + n; t < end;) {
    const std::size_t quad = t / 2, quads = std::min((end - 1) / 2 - quad + 1, kCornersAtOnce / 4);
    read_corners(mesh, 4 * quad, 4 * quads, corner);
    while (t < end && t / 2 < quad + quads) {
      const std::uint32_t* const c = corner + 4 * (t / 2 - quad);
      const auto& triangles = triangles_of_quad(mesh, c);
      do {
        for (const std::uint8_t k : triangles[t % 2]) *out++ = c[k];
        ++t;
      } while (t % 2 != 0 && t < end);
    }
  }
}

void read_runs(const MeshView& mesh, std::size_t t, std::size_t n, std::uint32_t* out) {
  const Runs runs{mesh};
  std::uint32_t corner[kCornersAtOnce];
  std::size_t face = runs.face_of(t);
  std::uint64_t k = t - runs.first_triangle(face);
  CutFace cut_face;
  const std::uint32_t* cut = cut_face(mesh, face, runs[face]);
  while (n > 0) {
    const Run run = runs[face];
    if (k >= run.triangles()) {
      ++face;
      k = 0;
      cut = cut_face(mesh, face, runs[face]);
      continue;
    }
    if (cut != nullptr) {
      const auto m = static_cast<std::size_t>(std::min<std::uint64_t>(n, run.triangles() - k));
      for (std::uint64_t i = 3 * k; i < 3 * (k + m); ++i) *out++ = mesh.vertex(run.begin + cut[i]);
      k += m;
      n -= m;
      continue;
    }
    const auto m = static_cast<std::size_t>(
        std::min<std::uint64_t>({n, run.triangles() - k, kCornersAtOnce - 2}));
    read_corners(mesh, run.begin + k, m + 2, corner);
    std::uint32_t apex = 0;
    read_corners(mesh, run.begin, 1, &apex);
    for (std::size_t i = 0; i < m; ++i, out += 3) {
      const std::size_t odd = (k + i) % 2;
      const bool fan = mesh.faces.kind == FaceKind::polygons;
      out[0] = fan ? apex : corner[i + odd];
      out[1] = corner[i + 1 - (fan ? 0 : odd)];
      out[2] = corner[i + 2];
    }
    k += m;
    n -= m;
  }
}

}  // namespace

std::size_t MeshView::face_count() const {
  switch (faces.kind) {
    case FaceKind::triangles:
      return corner_count() / 3;
    case FaceKind::quads:
      return corner_count() / 4;
    default:
      return Runs{*this}.count();
  }
}

std::size_t MeshView::triangle_count() const {
  switch (faces.kind) {
    case FaceKind::triangles:
      return corner_count() / 3;
    case FaceKind::quads:
      return corner_count() / 4 * 2;
    default: {
      const Runs runs{*this};
      if (runs.count() == 0) return 0;
      const std::size_t last = runs.count() - 1;
      return runs.first_triangle(last) + runs[last].triangles();
    }
  }
}

TrianglePlace MeshView::place_in_face(std::size_t t) const {
  TrianglePlace place{};
  if (faces.kind == FaceKind::quads) {
    place.face = t / 2;
    std::uint32_t vertex[4];
    read_corners(*this, 4 * place.face, 4, vertex);
    const auto& triangle = triangles_of_quad(*this, vertex)[t % 2];
    for (std::size_t c = 0; c < 3; ++c) place.corner[c] = 4 * place.face + triangle[c];
    return place;
  }
  const Runs runs{*this};
  place.face = runs.face_of(t);
  const Run run = runs[place.face];
  const std::size_t begin = run.begin, k = t - runs.first_triangle(place.face);
  CutFace cut_face;
  if (const std::uint32_t* const cut = cut_face(*this, place.face, run)) {
    for (std::size_t c = 0; c < 3; ++c) place.corner[c] = begin + cut[3 * k + c];
  } else if (faces.kind == FaceKind::polygons) {
    place = {{begin, begin + k + 1, begin + k + 2}, place.face};
  } else {
    place = {{begin + k + k % 2, begin + k + 1 - k % 2, begin + k + 2}, place.face};
  }
  return place;
}

void MeshView::read_triangles(std::size_t first, std::size_t n, std::uint32_t* vertices) const {
  switch (faces.kind) {
    case FaceKind::triangles:
      return read_corners(*this, 3 * first, 3 * n, vertices);
    case FaceKind::quads:
      return read_quads(*this, first, n, vertices);
    default:
      return read_runs(*this, first, n, vertices);
  }
}

std::string count_problem(std::size_t values, const std::string& array, std::size_t wanted,
                          const char* elements) {
  if (values == wanted) return {};
  return array + " are " + (values < wanted ? "fewer" : "more") + " (" + std::to_string(values) +
         ") than " + elements + " (" + std::to_string(wanted) + ")";
}

std::string positions_problem(std::size_t positions) {
  if (positions <= kNoIndex) return {};
  return "has " + std::to_string(positions) + " positions; at most " + std::to_string(kNoIndex) +
         " have a number";
}

std::string material_problem(std::uint32_t material, std::size_t materials) {
  if (material < std::max<std::size_t>(materials, 1)) return {};
  return "material " + std::to_string(material) + " is out of range, there are " +
         std::to_string(materials);
}

std::string faces_problem(const MeshView& mesh) {
  const IndexView& offsets = mesh.faces.offsets;
  if (mesh.faces.kind > FaceKind::strips)
    return "faces.kind is " + std::to_string(static_cast<int>(mesh.faces.kind)) +
           ", which is no value of its enum";
  if (std::string problem = positions_problem(mesh.positions.size()); !problem.empty())
    return problem;
  if (mesh.faces.kind < FaceKind::polygons) {
    const bool triangles = mesh.faces.kind == FaceKind::triangles;
    if (mesh.corner_count() % (triangles ? 3 : 4) != 0)
      return "has " + std::to_string(mesh.corner_count()) +
             (mesh.indices.empty() ? " positions without indices" : " indices") +
             ", which are no whole number of " + (triangles ? "triangles" : "quads");
  }
  if (offsets.empty()) return {};
  if (mesh.faces.kind < FaceKind::polygons) return "triangles and quads have no faces.offsets";
  for (std::size_t i = 0; i + 1 < offsets.size(); ++i) {
    const std::uint64_t begin = offsets.wide(i), end = offsets.wide(i + 1);
    if (end > mesh.corner_count() || begin > end || end - begin < 2)
      return "faces.offsets: face " + std::to_string(i) + " has the corners " + offsets.text(i) +
             " to " + offsets.text(i + 1) + " of " + std::to_string(mesh.corner_count()) +
             "; it must have two or more";
  }
  return {};
}

std::size_t first_beyond(const IndexView& indices, std::size_t size) {
  return first_beyond(indices, size, 0, indices.size());
}

std::size_t first_beyond(const IndexView& indices, std::size_t size, std::size_t begin,
                         std::size_t end) {
  std::uint32_t part[kCornersAtOnce];
  for (std::size_t i = begin; i < end; i += kCornersAtOnce) {
    const std::size_t n = std::min(kCornersAtOnce, end - i);
    indices.read(i, n, part);
    std::uint32_t largest = 0;
    for (std::size_t k = 0; k < n; ++k) largest = std::max(largest, part[k]);
    if (largest < size) continue;
    return i + static_cast<std::size_t>(
                   std::find_if(part, part + n, [&](std::uint32_t v) { return v >= size; }) - part);
  }
  return end;
}

void check_indices(const MeshView& mesh) {
  if (const std::string problem = faces_problem(mesh); !problem.empty())
    throw Error(Errc::invalid_argument, "mesh: " + problem);
  const std::size_t c = first_beyond(mesh.indices, mesh.positions.size());
  if (c == mesh.indices.size()) return;
  const bool lists = mesh.faces.kind == FaceKind::triangles;
  throw Error(Errc::invalid_argument,
              "mesh: corner " +
                  (lists ? std::to_string(c % 3) + " of triangle " + std::to_string(c / 3)
                         : std::to_string(c)) +
                  " is vertex " + mesh.indices.text(c) + ", but there are only " +
                  std::to_string(mesh.positions.size()));
}

template <class T>
AttributeView<T> Attribute<T>::view() const {
  return {values, indices};
}
template AttributeView<Vec2> Attribute<Vec2>::view() const;
template AttributeView<Vec3> Attribute<Vec3>::view() const;
template AttributeView<Vec4> Attribute<Vec4>::view() const;

MeshView Mesh::view() const {
  return {.positions =
              wide_positions.empty() ? ArrayView<Vec3>(positions) : ArrayView<Vec3>(wide_positions),
          .indices = indices,
          .normals = normals.view(),
          .texcoords = texcoords.view(),
          .colors = colors.view(),
          .color_space = color_space,
          .face_materials = face_materials,
          .material = material};
}

std::size_t Mesh::triangle_count() const {
  return view().triangle_count();
}

}  // namespace rastrum
