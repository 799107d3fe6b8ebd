// A scene of Python's: files and geometries in the order in which they were added.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "bindings.hpp"

namespace rastrum::python {

class ArrayScene {
 public:
  /// Meshes without normals get crease_normals, unless there is no `crease_deg`. Throws as
  /// io::read_scene, for builtin:SHAPE as shapes::scene_from_spec.
  void add_file(const std::string& file, std::optional<double> crease_deg);
  /// Files show their numbers of that name by `mapping` (of add_mapping); x, y, z and distance are
  /// made. Throws as rastrum::show_scalars.
  void show_scalars(const std::string& name, std::uint32_t mapping);
  /// About `count` isolines of a mapping at round numbers of its range, as it is now.
  void spread_isolines(std::size_t mapping, int count);
  void add_texture(const Array& pixels);
  void add_material(const Material& material) { materials_.push_back(material); }
  void add_mapping(const ScalarMapping& mapping) { mappings_.push_back(mapping); }
  /// `color`: display values; `material`: of add_material; `scalar`: a number for all of it;
  /// `mapping`: of add_mapping, for its scalars. The object must be an ArrayGeometry, and is kept
  /// alive.
  void add(nb::object geometry, const std::optional<Array>& transform, float opacity,
           const std::optional<Vec4>& color, std::optional<std::uint32_t> material, bool visible,
           const std::string& winding, std::optional<std::int64_t> id,
           std::vector<ClipPlane> clip_planes, std::optional<double> scalar, std::uint32_t mapping);

  /// As it stands; valid until the next change. Textures and materials of files come first.
  /// `beside_materials`: as beside what has some, though nothing here need have.
  [[nodiscard]] SceneView view(bool beside_materials = false) const;
  [[nodiscard]] std::uint64_t primitive_count() const;
  [[nodiscard]] const Scene& files() const { return files_; }

 private:
  struct Added {
    nb::object geometry;
    InstanceView instance;
    std::vector<ClipPlane> clip_planes;
    bool has_colors;
  };
  struct OfFile {
    std::size_t first, count;
  };
  void bind(bool beside_materials) const;

  Scene files_;
  std::vector<Material> materials_;
  std::vector<Texture> textures_;
  std::vector<ScalarMapping> mappings_;
  std::deque<std::variant<OfFile, Added>> order_;
  // What view() shows, made when it is first asked for.
  mutable bool bound_ = false, bound_beside_ = false;
  mutable std::optional<SceneBinding> binding_;
  mutable std::vector<InstanceView> instances_;
  mutable std::vector<Material> all_materials_;
  mutable std::vector<Texture> all_textures_;
};

}  // namespace rastrum::python
