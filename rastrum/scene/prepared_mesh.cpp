// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/prepared_mesh.hpp>

#include <optional>
#include <string>

#include <rastrum/core/float_scope.hpp>
#include <rastrum/core/no_memory.hpp>
#include <rastrum/error.hpp>
#include <rastrum/parallel/exec.hpp>
#include <rastrum/scene/mesh_clusters.hpp>

namespace rastrum {

PreparedMesh::PreparedMesh(const MeshView& mesh, int threads) : view_(mesh) {
  const FloatScope floats;
  check_indices(mesh);
  // Fewer triangles are not worth starting threads.
  constexpr std::size_t kLeast = 20'000;
  std::optional<parallel::Threads> own;
  if (threads != 1 && mesh.triangle_count() >= kLeast) own.emplace(threads);
  clusters_ = in_memory([&] {
    return Shared<const MeshClusters>(
        std::make_unique<const MeshClusters>(mesh, own ? &*own : nullptr));
  });
  view_.clusters = clusters_.get();
}

void PreparedMesh::check() const {
  const std::size_t changed = clusters_->first_changed();
  if (changed != clusters_->triangle.size())
    throw Error(Errc::invalid_argument,
                "mesh: triangle " + std::to_string(clusters_->triangle[changed]) +
                    " is not as it was prepared; prepare it again (PreparedMesh)");
}

std::size_t PreparedMesh::cluster_count() const {
  return clusters_->clusters.size();
}

std::uint64_t PreparedMesh::bytes() const {
  return clusters_->bytes();
}

}  // namespace rastrum
