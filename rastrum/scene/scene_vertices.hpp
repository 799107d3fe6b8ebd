// SPDX-License-Identifier: BSD-3-Clause
// The vertices that a scene's instances use, in runs with known boxes, for a fit.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <rastrum/fit.hpp>
#include <rastrum/scene.hpp>

namespace rastrum {

/// A mesh's vertices in use; positions of points and lines; for spheres, discs, tubes and
/// cylinders, places whose convex hull holds the drawn surface. Work and memory O(vertices +
/// triangles + instances), once for instances of one mesh.
class SceneVertices final : public FitVertices {
 public:
  /// `scene` must outlive this. Throws Error{invalid_argument} for an index out of range or too few
  /// radii.
  explicit SceneVertices(const SceneView& scene);

  [[nodiscard]] std::size_t runs() const override { return instance_of_.size(); }
  [[nodiscard]] std::optional<Box> box(std::size_t run) const override;
  [[nodiscard]] const Mat4d& object_to_world(std::size_t run) const override;
  void read(std::span<const std::size_t> runs,
            FunctionRef<void(std::size_t i, std::span<const Vec3d> vertices)> f) const override;

 private:
  struct Source {
    GeometryRef geometry;
    std::vector<bool> used{};  ///< of a mesh's positions
    std::vector<Box> boxes{};  ///< one per run
  };
  struct Instance {
    std::uint32_t source;
    std::size_t first_run;
  };

  [[nodiscard]] std::size_t run_in_source(std::size_t run) const {
    return run - instances_[instance_of_[run]].first_run;
  }
  template <class F>
  void visit(const Source& source, std::size_t run, const F& f) const;

  SceneView scene_;
  std::vector<Source> sources_;
  std::vector<Instance> instances_;
  std::vector<std::uint32_t> instance_of_;  ///< by run
};

}  // namespace rastrum
