// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "bindings.hpp"

namespace rastrum::python {

/// A Python thing's properties beside its arrays. Scenes read them, and the transform's numbers,
/// anew for each frame. The lock of the Python object guards them where Python has no GIL.
struct Look {
  std::optional<Array> transform{};  ///< (4, 4) or (3, 4) of float64
  float opacity = 1;
  std::optional<Vec4> color{};  ///< display values
  bool visible = true;
  bool casts_shadows = true;
  Winding winding = Winding::counter_clockwise;
  std::optional<std::int64_t> id{};
  std::vector<ClipPlane> clip_planes{};
};

/// Files, things, mappings and isolines are added before a second thread knows the scene. Textures
/// and materials may change while other threads draw it.
class ArrayScene {
 public:
  /// Data that frames of a scene share until something is added to it.
  struct Bound;
  /// The scene at a call of show(). Later changes affect the next call.
  struct Shown {
    std::shared_ptr<const Bound> bound{};
    std::vector<InstanceView> instances{};
    std::vector<std::size_t> of_things{};                           ///< the instance of each thing
    std::vector<std::shared_ptr<const GeometryView>> geometries{};  ///< not of files
    std::vector<ClipPlane> planes{};
    SceneView view{};

    /// The same with other places, a matrix for each thing. `moved`: memory for it.
    [[nodiscard]] SceneView at(std::span<const double> transforms,
                               std::vector<InstanceView>& moved) const;

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
  /// Returns its number.
  std::size_t add_texture(const Array& pixels);
  /// Replaces all materials. `of_things`: for each thing, without files, the number of its own.
  /// Frames see all of the change or nothing.
  void set_materials(std::vector<Material> materials,
                     std::vector<std::optional<std::uint32_t>> of_things);
  void add_mapping(const ScalarMapping& mapping);
  /// `scalar`: a number for the whole thing; `mapping`: an add_mapping's number, for its scalars.
  /// Keeps the objects, an ArrayGeometry and a Look, alive.
  void add(nb::object geometry, nb::object look, std::optional<double> scalar,
           std::uint32_t mapping);

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
    std::size_t number;  ///< among the things
  };
  struct OfFile {
    std::size_t first, count;
  };
  [[nodiscard]] std::shared_ptr<const Bound> bind(bool beside_materials) const;

  /// Guards all below where Python has no GIL. No Python code runs while it is held, so that a fork
  /// finds it free.
  mutable nb::ft_mutex mutex_{};
  Scene files_;
  std::vector<Material> materials_;
  std::vector<std::optional<std::uint32_t>> material_of_;  ///< for each thing
  std::shared_ptr<std::vector<Texture>> textures_ = std::make_shared<std::vector<Texture>>();
  std::vector<ScalarMapping> mappings_;
  std::deque<std::variant<OfFile, Added>> order_;
  std::size_t things_ = 0;
  mutable std::shared_ptr<const Bound> bound_;
  mutable std::optional<std::uint64_t> primitives_;
};

}  // namespace rastrum::python
