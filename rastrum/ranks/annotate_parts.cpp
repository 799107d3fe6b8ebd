// SPDX-License-Identifier: BSD-3-Clause
// Annotations over a picture of ranks. The root draws them over its finished picture, from what
// ranks agree on about the whole scene.
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include <rastrum/core/float_scope.hpp>
#include <rastrum/core/reject.hpp>
#include <rastrum/error.hpp>
#include <rastrum/ranks.hpp>
#include <rastrum/ranks/render_parts.hpp>
#include <rastrum/render/target_checks.hpp>
#include <rastrum/stop.hpp>

namespace rastrum {
namespace {

void check_alike(const Annotations& a, const SceneView& scene, const Targets& targets,
                 bool is_root) {
  check(a);
  if (!is_root) return;
  check_annotated(targets);
  if (a.bar && scene.scalar_mappings.empty())
    reject("Annotations::bar: needs things with scalars; the root has none");
}

/// As Annotator computes it for a scene.
double occlusion_radius(Communicator& ranks, const SceneView& scene) {
  FitOfRanks fit(ranks);
  return 0.15 * bounding_sphere(scene, &fit).radius;
}

/// Stands for the whole scene, with what the root's drawing reads: the box, as two points, and the
/// mappings.
struct StandIn {
  StandIn(const Bounds& box, std::span<const ScalarMapping> mappings)
      : positions{box.min, box.max} {
    points.positions = positions;
    instance.geometry = points;
    if (box.vertices_in_use != 0) scene.instances = {&instance, 1};
    scene.scalar_mappings = mappings;
  }
  std::vector<Vec3d> positions;
  PointsView points;
  InstanceView instance;
  SceneView scene;
};

}  // namespace

RanksStats render_parts(Communicator& communicator, Renderer& renderer, Annotator& annotator,
                        const SceneView& scene, std::span<const std::uint64_t> parts,
                        const Camera& camera, const FrameOptions& frame,
                        const Annotations& annotations, const Targets& targets,
                        const RanksOptions& options, StopToken stop) {
  const FloatScope floats;
  const StopScope scope(stop);
  const bool is_root = communicator.rank() == options.root;
  Annotations a = annotations;
  FrameOptions drawn;
  Targets all;
  // Where textures blend, effects need another picture, of a surface with holes
  // (Annotator::add_surface).
  const bool has_surface =
      frame.transparency.method != Transparency::none && (a.occlusion || a.dome || a.silhouettes);
  // Progress covers both pictures; annotations count as one more.
  const std::uint64_t steps = has_surface ? 3 : 2;
  RanksOptions first = options, second = options;
  do_alike(communicator, "check annotations", [&] {
    drawn = with_infinity(frame);
    check_alike(a, scene, targets, is_root);
    if (options.progress) {
      first.progress = [&](std::string_view what, std::uint64_t done, std::uint64_t rows) {
        options.progress(what, done, steps * rows);
      };
      second.progress = [&](std::string_view what, std::uint64_t done, std::uint64_t rows) {
        options.progress(what, rows + done, steps * rows);
      };
    }
    if (options.rows != 0)
      throw Error(Errc::unsupported,
                  "annotations are drawn over a whole picture, not in bands of rows");
    if (!is_root) return;
    all = targets;
    annotator.add_targets(a, frame.width, frame.height, all);
  });
  // The collective calls below depend on these, so they must be the same on all ranks.
  const bool asks[] = {a.occlusion.has_value(), a.occlusion && a.occlusion->radius == 0,
                       a.dome.has_value(),      a.silhouettes.has_value(),
                       a.edges.has_value(),     a.bounds,
                       a.bar.has_value()};
  std::uint64_t kind = 0;
  for (const bool ask : asks) kind = 2 * kind + (ask ? 1 : 0);
  const std::uint64_t greatest = communicator.max(kind), least = ~communicator.max(~kind);
  do_alike(communicator, "compare annotations", [&] {
    if (least != greatest) reject("the ranks were given different annotations");
  });
  if (a.occlusion && a.occlusion->radius == 0)
    a.occlusion->radius = occlusion_radius(communicator, scene);
  Bounds box;
  if (a.bounds) box = bounds_of_ranks(communicator, scene);
  std::vector<ScalarMapping> mappings;
  if (a.bar) mappings = mappings_of_ranks(communicator, scene);

  Image<float> factor;
  std::optional<ranks::EdgesOfParts> edges;
  if (a.edges)
    do_alike(communicator, "make room for edges", [&] {
      if (is_root) factor = Image<float>(frame.width, frame.height);
      edges = {*a.edges, factor};
    });
  const RanksStats stats = ranks::render_parts(communicator, renderer, scene, parts, camera, drawn,
                                               all, first, {}, edges ? &*edges : nullptr);

  if (has_surface) {
    SceneView solid = scene;
    std::vector<Material> materials;
    do_alike(communicator, "look for blending textures", [&] {
      materials = materials_of_surface(scene);
      if (!materials.empty()) solid.materials = materials;
    });
    if (communicator.max(materials.empty() ? 0 : 1) != 0) {
      std::optional<Targets> of_surface;
      do_alike(communicator, "make images of the surface", [&] {
        if (is_root)
          annotator.add_surface(a, frame.width, frame.height,
                                [&](const Targets& t) { of_surface = t; });
      });
      (void)render_parts(communicator, renderer, solid, parts, camera, drawn,
                         of_surface.value_or(Targets{}), second);
    }
  }
  do_alike(communicator, "annotate", [&] {
    const auto rows = static_cast<std::uint64_t>(frame.height);
    if (options.progress) options.progress("annotate", (steps - 1) * rows, steps * rows);
    if (is_root) {
      const StandIn whole(box, mappings);
      if (a.edges) annotator.add_edges(factor);
      annotator.draw(a, whole.scene, camera, frame.background, all);
      set_no_distance(targets, frame.no_distance);
    }
    if (options.progress) options.progress("annotate", steps * rows, steps * rows);
  });
  return stats;
}

}  // namespace rastrum
