// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/io/ply_pictures.hpp>

#include <algorithm>
#include <utility>

#include <rastrum/io/beside.hpp>
#include <rastrum/io/parse.hpp>
#include <rastrum/io/pictures.hpp>
#include <rastrum/io/wide_positions.hpp>

namespace rastrum::io {

void PlyPictures::add_face(const std::vector<double>& uv, const std::vector<std::uint32_t>& corners,
                           double number, std::size_t indices) {
  const auto all = static_cast<std::uint32_t>(names_.size());
  Budget& budget = reading_.budget;
  budget.resize(texcoords_.indices, indices - corners.size(), kNone);
  budget.resize(pictures_, texcoords_.indices.size() / 3, all);
  const auto first = static_cast<std::uint32_t>(texcoords_.values.size());
  for (std::size_t c = 0; c + 1 < uv.size(); c += 2)
    budget.add(texcoords_.values, {float32_of(uv[c]), 1 - float32_of(uv[c + 1])});
  for (const std::uint32_t c : corners)
    budget.add(texcoords_.indices, uv.empty() ? kNone : first + c);
  const bool has_one = !uv.empty() && number >= 0 && number < all;
  budget.resize(pictures_, texcoords_.indices.size() / 3,
                has_one ? static_cast<std::uint32_t>(number) : all);
}

void PlyPictures::finish(Mesh& mesh, Scene& scene, std::vector<std::string>& warnings,
                         std::vector<std::string>& unused) {
  const auto all = static_cast<std::uint32_t>(names_.size());
  std::vector<std::uint32_t> pictures;
  reading_.budget.resize(pictures, mesh.indices.size() / 3);
  if (!texcoords_.values.empty()) {
    // Faces of other elements have none.
    (void)corners(mesh.indices.size());
    reading_.budget.resize(pictures_, pictures.size(), all);
    std::ranges::replace(texcoords_.indices, kNone,
                         static_cast<std::uint32_t>(texcoords_.values.size()));
    texcoords_.values.push_back({0, 0});
    mesh.texcoords = std::move(texcoords_);
    pictures = std::move(pictures_);
  }
  if (names_.empty()) return;
  if (mesh.texcoords.empty() || mesh.indices.empty()) {
    unused.push_back("the picture " + names_[0].substr(0, 100));
    return;
  }
  for (const std::string& name : names_) {
    Material m = plain_material(true);
    m.name = name;
    m.alpha_mode = AlphaMode::opaque;
    m.base_color_texture = read(scene, name, warnings);
    scene.materials.push_back(std::move(m));
  }
  if (std::ranges::find(pictures, all) != pictures.end())
    scene.materials.push_back(plain_material(false));
  set_materials(mesh, std::move(pictures));
  if (mesh.colors.empty()) return;
  warnings.push_back(file_.string() + ": its colours are left out: its picture has them");
  mesh.colors = {};
}

std::int32_t PlyPictures::read(Scene& scene, const std::string& name,
                               std::vector<std::string>& warnings) {
  const FoundFile found = find_beside(file_.parent_path(), name);
  return add_texture(scene.textures, warnings, file_.string(), found.path, [&] {
    Texture t{.image =
                  decode_picture(reading_.open(found.path), found.path.string(), reading_.budget)};
    if (!found.as_named)
      warnings.push_back(file_.string() + ": read from beside this file: " + name);
    return t;
  });
}

}  // namespace rastrum::io
