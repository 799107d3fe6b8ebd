// SPDX-License-Identifier: BSD-3-Clause
// A scene's instances in runs of alike ones, so that common data is kept and checked once: a
// million instances of a mesh are one run.
#pragma once

#include <cstddef>
#include <list>
#include <vector>

#include <rastrum/parallel/exec.hpp>
#include <rastrum/scene.hpp>
#include <rastrum/scene/face_cuts.hpp>

namespace rastrum {

/// Whether the transform turns faces inside out.
[[nodiscard]] bool is_mirroring(const Mat4d& object_to_world);

/// The winding of fronts in the world: a mirroring transform turns those of meshes.
[[nodiscard]] Winding winding_of(const InstanceView& instance);

/// A run's instances are consecutive, draw one mesh and differ only in matrices, ids and colours
/// (all or none mirror; all or none have a colour; all or none of those are opaque). An instance
/// that is no mesh, or has clip planes or scalars, is its own run.
class InstanceRuns {
 public:
  /// `scene` must outlive this. Without `joins` each instance is a run. O(instances), on `threads`
  /// (null: one).
  InstanceRuns(const SceneView& scene, bool joins, parallel::Threads* threads);

  /// Finds once which polygons are no fans (MeshView::cuts). Requires valid faces.
  void cut_faces(parallel::Threads* threads);

  [[nodiscard]] const SceneView& firsts() const { return firsts_; }
  [[nodiscard]] const InstanceView* instances(std::size_t run) const {
    return scene_.instances.data() + number(run);
  }
  /// The number in the scene of the run's first instance.
  [[nodiscard]] std::size_t number(std::size_t run) const {
    return begin_.empty() ? run : begin_[run];
  }
  [[nodiscard]] std::size_t length(std::size_t run) const {
    return begin_.empty() ? 1 : begin_[run + 1] - begin_[run];
  }

 private:
  SceneView scene_;
  SceneView firsts_;
  std::vector<std::size_t> begin_;  ///< one more than runs; empty: all have length 1
  std::vector<InstanceView> list_;  ///< of firsts_, where some run is longer or has cuts
  std::list<FaceCuts> cuts_;
  std::list<MeshView> meshes_;  ///< with cuts, of instances of list_
};

}  // namespace rastrum
