// SPDX-License-Identifier: BSD-3-Clause
// Pictures of PLY files as MeshLab writes them: `comment TextureFile NAME` in the header, and
// texture coordinates of vertices, or per face a list `texcoord` of its corners and the picture's
// number, `texnumber`.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <rastrum/io/reading.hpp>
#include <rastrum/scene.hpp>

namespace rastrum::io {

class PlyPictures {
 public:
  PlyPictures(const std::filesystem::path& file, const std::vector<std::string>& names,
              Reading& reading)
      : file_(file), names_(names), reading_(reading) {}

  [[nodiscard]] bool any() const { return !names_.empty(); }

  /// Adds a face. `uv`: u and v per corner, or nothing. `number`: its picture. `corners`: the
  /// face's corner for each corner of its triangles. `indices`: the number of the mesh's indices,
  /// of which this face's are the last.
  void add_face(const std::vector<double>& uv, const std::vector<std::uint32_t>& corners,
                double number, std::size_t indices);

  [[nodiscard]] bool has_faces() const { return !texcoords_.values.empty(); }
  /// The texture coordinates of add_face, one index for each of `indices` corners.
  [[nodiscard]] std::vector<std::uint32_t>& corners(std::size_t indices) {
    reading_.budget.resize(texcoords_.indices, indices, kNone);
    return texcoords_.indices;
  }

  /// Gives the mesh its coordinates and materials. Adds the names of data that are not drawn to
  /// `unused`.
  void finish(Mesh& mesh, Scene& scene, std::vector<std::string>& warnings,
              std::vector<std::string>& unused);

 private:
  std::int32_t read(Scene& scene, const std::string& name, std::vector<std::string>& warnings);

  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  const std::filesystem::path& file_;
  const std::vector<std::string>& names_;
  Reading& reading_;
  Attribute<Vec2> texcoords_;            ///< of the corners of faces
  std::vector<std::uint32_t> pictures_;  ///< of triangles; the number of all pictures: none
};

}  // namespace rastrum::io
