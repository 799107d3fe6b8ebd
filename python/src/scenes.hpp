// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "bindings.hpp"

namespace rastrum::python {

/// A Python thing's properties beside its arrays. Scenes read them, and the transform's numbers,
/// anew for each frame.
struct Look {
  std::optional<Array> transform{};  ///< (4, 4) or (3, 4) of float64
  float opacity = 1;
  std::optional<Vec4> color{};  ///< display values
  bool visible = true;
  Winding winding = Winding::counter_clockwise;
  std::optional<std::int64_t> id{};
  std::vector<ClipPlane> clip_planes{};
};

class ArrayScene {
 public:
  /// Data that frames of a scene share until something is added to it.
  struct Bound;
  /// The scene at a call of show(). Later changes affect the next call.
  struct Shown {
    std::shared_ptr<const Bound> bound{};
    std::vector<InstanceView> instances{};
    std::vector<std::shared_ptr<const GeometryView>> geometries{};  ///< not of files
    std::vector<ClipPlane> planes{};
    SceneView view{};

    Shown() = default;
    Shown(Shown&&) = default;
    Shown& operator=(Shown&&) = default;
  };

  /// Meshes without normals get crease_normals if `crease_deg` is given. Throws as io::read_scene,
  /// or for builtin:SHAPE as shapes::scene_from_spec.
  void add_file(const std::string& file, std::optional<double> crease_deg,
                std::optional<std::uint64_t> memory_limit, bool allow_outside);
  /// Files show their numbers of that name by `mapping` (of add_mapping); x, y, z and distance are
  /// made. Throws as rastrum::show_scalars.
  void show_scalars(const std::string& name, std::uint32_t mapping);
  /// About `count` isolines at round numbers of the mapping's present range.
  void spread_isolines(std::size_t mapping, int count);
  void add_texture(const Array& pixels);
  /// Replaces the material with that number, or appends it.
  void set_material(std::size_t number, const Material& material);
  /// Removes the materials of set_material from all things.
  void drop_materials();
  void add_mapping(const ScalarMapping& mapping);
  /// `scalar`: a number for the whole thing; `mapping`: an add_mapping's number, for its scalars.
  /// Keeps the objects, an ArrayGeometry and a Look, alive.
  void add(nb::object geometry, nb::object look, std::optional<double> scalar,
           std::uint32_t mapping);
  /// `material`: a number of set_material; `thing`: its number, without files.
  void set_material_of(std::size_t thing, std::optional<std::uint32_t> material);

  /// The present scene. Textures and materials of files come first. `beside_materials`: as if the
  /// scene had materials. Requires the GIL.
  [[nodiscard]] Shown show(bool beside_materials = false) const;
  [[nodiscard]] std::uint64_t primitive_count() const;
  [[nodiscard]] const Scene& files() const { return files_; }

 private:
  struct Added {
    nb::object geometry, look;
    std::optional<double> scalar;
    std::uint32_t mapping;
    std::optional<std::uint32_t> material{};
  };
  struct OfFile {
    std::size_t first, count;
  };
  [[nodiscard]] std::shared_ptr<const Bound> bind(bool beside_materials) const;
  void has_changed() { bound_.reset(); }

  Scene files_;
  std::vector<Material> materials_;
  std::shared_ptr<std::vector<Texture>> textures_ = std::make_shared<std::vector<Texture>>();
  std::vector<ScalarMapping> mappings_;
  std::deque<std::variant<OfFile, Added>> order_;
  std::vector<Added*> added_;
  mutable std::shared_ptr<const Bound> bound_;
  mutable std::optional<std::uint64_t> primitives_;
};

}  // namespace rastrum::python
