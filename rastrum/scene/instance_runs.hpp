// SPDX-License-Identifier: BSD-3-Clause
// The instances of a scene in runs of alike ones, so that their common data is kept and checked
// once: a million instances of one mesh are one run.
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

/// How the fronts of an instance's primitives are wound in the world: a mirroring transform turns
/// those of meshes.
[[nodiscard]] Winding winding_of(const InstanceView& instance);

/// The instances of a run lie one after the other in the scene, draw one mesh and differ only in
/// their matrices, ids and colours (all or none mirror; all or none have a colour, and all or none
/// of those are opaque). An instance that is not a mesh, or has clip planes or scalars, is a run of
/// its own.
class InstanceRuns {
 public:
  /// `scene` must outlive this. Without `joins` each instance is a run. O(instances), divided among
  /// `threads` (null: one).
  InstanceRuns(const SceneView& scene, bool joins, parallel::Threads* threads);

  /// Finds out once which polygons are not fans (MeshView::cuts). Requires valid faces.
  void cut_faces(parallel::Threads* threads);

  /// The scene with only the first instance of each run.
  [[nodiscard]] const SceneView& firsts() const { return firsts_; }
  /// The scene's instances from the first of run `run` on.
  [[nodiscard]] const InstanceView* instances(std::size_t run) const {
    return scene_.instances.data() + number(run);
  }
  /// Which of the scene's instances is the first of run `run`.
  [[nodiscard]] std::size_t number(std::size_t run) const {
    return begin_.empty() ? run : begin_[run];
  }
  [[nodiscard]] std::size_t length(std::size_t run) const {
    return begin_.empty() ? 1 : begin_[run + 1] - begin_[run];
  }

 private:
  SceneView scene_;
  SceneView firsts_;
  std::vector<std::size_t> begin_;  ///< one more than there are runs; empty: all have length 1
  std::vector<InstanceView> list_;  ///< of firsts_, where some run is longer or has cuts
  std::list<FaceCuts> cuts_;
  std::list<MeshView> meshes_;  ///< with cuts, of instances of list_
};

}  // namespace rastrum
