#include <rastrum/prepared_mesh.hpp>

#include <optional>

#include <rastrum/parallel/exec.hpp>
#include <rastrum/scene/mesh_clusters.hpp>

namespace rastrum {

PreparedMesh::PreparedMesh(const MeshView& mesh, int threads) : view_(mesh) {
  check_indices(mesh);
  // Threads are not worth starting for less.
  constexpr std::size_t kLeast = 20'000;
  std::optional<parallel::Threads> own;
  if (threads != 1 && mesh.triangle_count() >= kLeast) own.emplace(threads);
  clusters_ = std::make_shared<const MeshClusters>(mesh, own ? &*own : nullptr);
  view_.clusters = clusters_.get();
}

std::size_t PreparedMesh::cluster_count() const {
  return clusters_->clusters.size();
}

std::uint64_t PreparedMesh::bytes() const {
  return clusters_->bytes();
}

}  // namespace rastrum
