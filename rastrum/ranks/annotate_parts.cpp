// Annotations over a picture of ranks: the root draws them over its finished picture, by what ranks
// have agreed on of the whole scene.
#include <algorithm>
#include <limits>
#include <optional>
#include <vector>

#include <rastrum/core/elementary.hpp>
#include <rastrum/error.hpp>
#include <rastrum/ranks.hpp>

namespace rastrum {
namespace {

void check_alike(const Annotations& a, const SceneView& scene, const Targets& targets,
                 bool is_root) {
  check(a);
  if (a.edges)
    throw Error(Errc::unsupported,
                "Annotations::edges: not with several ranks, each of which knows the edges of its "
                "own parts");
  if (!is_root) return;
  if (targets.color8.empty() && targets.color.empty())
    throw Error(Errc::invalid_argument,
                "Annotations: are drawn into Targets::color8 or Targets::color; both are empty");
  if (a.bar && scene.scalar_mappings.empty())
    throw Error(Errc::invalid_argument,
                "Annotations::bar: is of things with scalars; the root has none");
}

/// As Annotator has it of a scene.
double occlusion_radius(Communicator& ranks, const SceneView& scene) {
  constexpr float kFov = 1;
  FitOfRanks fit(ranks);
  const Camera all = fit_camera(scene, kFov, false, {0, 0, -1}, {0, 1, 0}, &fit);
  return 0.15 * (length(all.eye - all.target) * elementary::sin(double{kFov} / 2));
}

/// What the root's drawing asks the whole scene for: its box, by two points, and its mappings.
struct StandIn {
  StandIn(const Bounds& box, std::span<const ScalarMapping> mappings)
      : positions{box.min, box.max} {
    points.positions = positions;
    instance.geometry = points;
    if (box.vertices_in_use != 0) scene.instances = {&instance, 1};
    scene.scalar_mappings = mappings;
  }
  std::vector<Vec3> positions;
  PointsView points;
  InstanceView instance;
  SceneView scene;
};

}  // namespace

RanksStats render_parts(Communicator& ranks, Renderer& renderer, Annotator& annotator,
                        const SceneView& scene, std::span<const std::uint64_t> parts,
                        const Camera& camera, const FrameOptions& frame,
                        const Annotations& annotations, const Targets& targets,
                        const RanksOptions& options) {
  const bool is_root = ranks.rank() == options.root;
  Annotations a = annotations;
  Targets all;
  do_alike(ranks, "check annotations", [&] {
    check_alike(a, scene, targets, is_root);
    if (options.rows != 0)
      throw Error(Errc::unsupported,
                  "annotations are drawn over a whole picture, not in bands of rows");
    if (!is_root) return;
    all = targets;
    annotator.add_targets(a, frame.width, frame.height, all);
    // What effects look at.
    all.no_distance = std::numeric_limits<float>::infinity();
  });
  // What ranks do together from here on depends on these.
  const bool asks[] = {a.occlusion.has_value(),
                       a.occlusion && a.occlusion->radius == 0,
                       a.dome.has_value(),
                       a.silhouettes.has_value(),
                       a.bounds,
                       a.bar.has_value()};
  std::uint64_t kind = 0;
  for (const bool ask : asks) kind = 2 * kind + (ask ? 1 : 0);
  const std::uint64_t greatest = ranks.max(kind), least = ~ranks.max(~kind);
  do_alike(ranks, "compare annotations", [&] {
    if (least != greatest)
      throw Error(Errc::invalid_argument, "the ranks were given different annotations");
  });
  if (a.occlusion && a.occlusion->radius == 0) a.occlusion->radius = occlusion_radius(ranks, scene);
  Bounds box;
  if (a.bounds) box = bounds_of_ranks(ranks, scene);
  std::vector<ScalarMapping> mappings;
  if (a.bar) mappings = mappings_of_ranks(ranks, scene);

  const RanksStats stats = render_parts(ranks, renderer, scene, parts, camera, frame, all, options);

  // Where textures blend, effects look at a surface that has holes (Annotator::add_surface).
  if (frame.transparency.method != Transparency::none && (a.occlusion || a.dome || a.silhouettes)) {
    SceneView solid = scene;
    std::vector<Material> materials;
    do_alike(ranks, "look for blending textures", [&] {
      materials = materials_of_surface(scene);
      if (!materials.empty()) solid.materials = materials;
    });
    const auto draw = [&](const Targets& of_surface) {
      (void)render_parts(ranks, renderer, solid, parts, camera, frame, of_surface, options);
    };
    if (ranks.max(materials.empty() ? 0 : 1) != 0) {
      std::optional<Targets> of_surface;
      do_alike(ranks, "make images of the surface", [&] {
        if (is_root)
          annotator.add_surface(a, frame.width, frame.height,
                                [&](const Targets& t) { of_surface = t; });
      });
      draw(of_surface.value_or(Targets{}));
    }
  }
  do_alike(ranks, "annotate", [&] {
    if (!is_root) return;
    const StandIn whole(box, mappings);
    annotator.draw(a, whole.scene, camera, frame.background, all);
    if (targets.no_distance == all.no_distance) return;
    for (const ImageView<float>& image : {targets.view_depth, targets.distance})
      for (int y = 0; y < image.height && !image.empty(); ++y)
        std::replace(image.row(y), image.row(y) + image.width, all.no_distance,
                     targets.no_distance);
  });
  return stats;
}

}  // namespace rastrum
