#include <rastrum/render/scene_on_terrain.hpp>

#include <string>
#include <utility>

#include <rastrum/core/error.hpp>
#include <rastrum/core/quaternion.hpp>
#include <rastrum/terrain/matrix.hpp>

namespace rastrum {

SceneOnTerrain::SceneOnTerrain(RenderOptions options)
    : renderer_(std::move(options)), depth_(renderer_.options().width, renderer_.options().height) {
  const RenderOptions& o = renderer_.options();
  if (o.device == Device::threads) threads_ = std::make_unique<parallel::Threads>(o.threads);
}

template <class Row>
void SceneOnTerrain::for_each_row(const Row& row) {
  const auto rows = static_cast<std::size_t>(depth_.height());
  const auto call = [&](std::size_t y) { row(static_cast<int>(y)); };
  if (threads_)
    parallel::for_each_index(*threads_, rows, call);
  else
    for (std::size_t y = 0; y < rows; ++y) call(y);
}

FrameStats SceneOnTerrain::draw(const TerrainScene& given, const terrain::TerrainOptions& options,
                                const terrain::TerrainCamera& camera,
                                const terrain::TerrainTargets& picture) {
  const int width = depth_.width(), height = depth_.height();
  if (options.width != width || options.height != height)
    throw Error(Errc::invalid_argument,
                "what stands on a terrain is drawn at " + std::to_string(width) + "x" +
                    std::to_string(height) + ", the terrain at " + std::to_string(options.width) +
                    "x" + std::to_string(options.height) +
                    "; give RenderOptions and TerrainOptions the same size");
  if (picture.depth.empty())
    throw Error(Errc::invalid_argument,
                "to stand on a terrain its depth is needed: draw both with TerrainTargets::depth");
  check_size(picture.depth, width, height, "the depth target");
  check_size(picture.color8, width, height, "the color8 target");
  Camera view;
  view.matrix = terrain::world_to_clip(options, camera, kNear);

  instances_.assign(given.scene.instances.begin(), given.scene.instances.end());
  for (const std::size_t i : given.facing) {
    if (i >= instances_.size())
      throw Error(Errc::invalid_argument, std::string("no instance has the number ")
                                              .append(std::to_string(i))
                                              .append(" that is to face the camera"));
    // As the terrain's camera turns: 0 faces +z, the south.
    instances_[i].object_to_world =
        instances_[i].object_to_world * rotation(rotation_about({0, 1, 0}, camera.angle_rad));
  }
  SceneView scene = given.scene;
  scene.instances = instances_;

  for_each_row([&](int y) {
    for (int x = 0; x < width; ++x)
      depth_(x, y) = terrain::reversed_depth(picture.depth(x, y), kNear);
  });
  Targets targets;
  targets.color8 = picture.color8;
  targets.depth = depth_.view();
  targets.over = true;
  const FrameStats stats = renderer_.render(scene, view, targets);
  for_each_row([&](int y) {
    for (int x = 0; x < width; ++x)
      // What is the terrain's keeps its bits.
      if (depth_(x, y) != terrain::reversed_depth(picture.depth(x, y), kNear))
        picture.depth(x, y) = static_cast<float>(kNear / static_cast<double>(depth_(x, y)));
  });
  return stats;
}

}  // namespace rastrum
