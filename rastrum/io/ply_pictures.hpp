// Pictures of PLY files, as MeshLab writes them: `comment TextureFile NAME` in the header, and
// texture coordinates of vertices, or a list `texcoord` of each face's corners with `texnumber`,
// which of the pictures it has.
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

  /// Of a face `uv` are u and v of each corner, none where it has none, and `number` is its
  /// picture's. The last of the mesh's `indices` are its triangles'; `corners`: which of the face's
  /// each has.
  void add_face(const std::vector<double>& uv, const std::vector<std::uint32_t>& corners,
                double number, std::size_t indices);

  [[nodiscard]] bool has_faces() const { return !texcoords_.values.empty(); }
  /// What add_face has noted of `indices` corners, one number each.
  [[nodiscard]] std::vector<std::uint32_t>& corners(std::size_t indices) {
    reading_.budget.resize(texcoords_.indices, indices, kNone);
    return texcoords_.indices;
  }

  /// Gives the mesh its coordinates and materials. What is to be said goes to `warnings`, what is
  /// not drawn to `unused`.
  void finish(Mesh& mesh, Scene& scene, std::vector<std::string>& warnings,
              std::vector<std::string>& unused);

 private:
  std::int32_t read(Scene& scene, const std::string& name, std::vector<std::string>& warnings);

  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  const std::filesystem::path& file_;
  const std::vector<std::string>& names_;
  Reading& reading_;
  Attribute<Vec2> texcoords_;            ///< of faces' corners
  std::vector<std::uint32_t> pictures_;  ///< of triangles; the one behind all is none
};

}  // namespace rastrum::io
