#include <rastrum/render/surfaces.hpp>

#include <algorithm>
#include <string>

#include <rastrum/error.hpp>
#include <rastrum/raster/shade/alpha.hpp>
#include <rastrum/scene/mesh_checks.hpp>

namespace rastrum {
namespace {

/// Checks the arrays of an instance.
class Check {
 public:
  explicit Check(std::size_t instance) : instance_(instance) {}

  void operator()(const SpheresView& s) const {
    each(s.radii.size(), "radii", s.size(), "spheres");
    each(s.colors.size(), "colors", s.size(), "spheres");
    each(s.scalars.size(), "scalars", s.size(), "spheres");
  }
  void operator()(const CylindersView& c) const {
    of_positions(c.radii.size(), c.colors.size(), c.scalars.size(), c.positions.size());
    if (const std::size_t ends = c.indices.empty() ? c.positions.size() : c.indices.size();
        ends % 2 != 0)
      fail("the number of ends, " + std::to_string(ends) + ", is odd");
    if (const std::size_t at = first_beyond(c.indices, c.positions.size()); at != c.indices.size())
      fail("indices[" + std::to_string(at) + "]: index " + c.indices.text(at) +
           " is out of range, there are " + std::to_string(c.positions.size()) + " positions");
  }
  void operator()(const TubesView& t) const {
    of_positions(t.radii.size(), t.colors.size(), t.scalars.size(), t.positions.size());
    // Negative ones are beyond all positions.
    for (std::size_t i = 0; i < t.offsets.size(); ++i)
      if (t.offsets.wide(i) > t.positions.size())
        fail(offset(t, i) + ", but there are " + std::to_string(t.positions.size()) + " positions");
      else if (i > 0 && t.offsets.wide(i) <= t.offsets.wide(i - 1))
        fail(offset(t, i) + ", which does not lie above the one before, " + t.offsets.text(i - 1));
  }
  void operator()(const DiscsView& d) const {
    each(d.radii.size(), "radii", d.size(), "discs");
    each(d.colors.size(), "colors", d.size(), "discs");
    each(d.scalars.size(), "scalars", d.size(), "discs");
    none(count_problem(d.normals.size(), "normals", d.size(), "discs"));
  }
  void material(std::uint32_t m, std::size_t materials) const {
    none(material_problem(m, materials));
  }

 private:
  [[noreturn]] void fail(const std::string& problem) const {
    throw Error(Errc::invalid_argument, "instance " + std::to_string(instance_) + ": " + problem);
  }
  void none(const std::string& problem) const {
    if (!problem.empty()) fail(problem);
  }
  /// Throws unless there is one for each, or none.
  void each(std::size_t values, const char* what, std::size_t wanted, const char* elements) const {
    if (values != 0) none(count_problem(values, what, wanted, elements));
  }
  void of_positions(std::size_t radii, std::size_t colors, std::size_t scalars,
                    std::size_t positions) const {
    each(radii, "radii", positions, "positions");
    each(scalars, "scalars", positions, "positions");
    each(colors, "colors", positions, "positions");
  }

  static std::string offset(const TubesView& t, std::size_t i) {
    return "offsets[" + std::to_string(i) + "] is " + t.offsets.text(i);
  }

  std::size_t instance_;
};

bool is_translucent(const raster::QuadricGeometry& geometry, const InstanceView& instance,
                    const Material* material, parallel::Threads* threads) {
  if (material != nullptr) return material->alpha_mode == AlphaMode::blend || material->opacity < 1;
  return raster::has_color_alpha(
      instance, std::visit([](const auto& g) { return g.colors; }, geometry), threads);
}

bool is_translucent(const raster::SurfaceScalars& scalars, const Material* material) {
  return scalars.colors()->is_translucent() || (material != nullptr && material->opacity < 1);
}

}  // namespace

std::optional<raster::QuadricGeometry> quadrics_of(const GeometryView& geometry) {
  if (const auto* const s = std::get_if<SpheresView>(&geometry)) return *s;
  if (const auto* const c = std::get_if<CylindersView>(&geometry)) return *c;
  if (const auto* const t = std::get_if<TubesView>(&geometry)) return *t;
  if (const auto* const d = std::get_if<DiscsView>(&geometry)) return *d;
  return std::nullopt;
}

void check_surfaces(const InstanceRuns& runs) {
  const SceneView& scene = runs.firsts();
  for (std::size_t i = 0; i < scene.instances.size(); ++i)
    if (const auto geometry = quadrics_of(scene.instances[i].geometry)) {
      const Check check(runs.number(i));
      check.material(raster::material_of(scene.instances[i]), scene.materials.size());
      std::visit(check, *geometry);
    }
}

bool SurfaceDraws::add(const InstanceView& instance, const raster::SurfaceScalars& scalars,
                       const Mat4d& world_to_clip, raster::Draw& draw, parallel::Threads* threads) {
  const auto geometry = quadrics_of(instance.geometry);
  if (!geometry) return false;
  const raster::QuadricStage& stage =
      stages_.emplace_back(*geometry, world_to_clip * instance.object_to_world);
  shader_.add(stage, instance, scalars);
  draw.quadrics = &stage;
  draw.primitive_count = std::visit([](const auto& g) { return g.size(); }, *geometry);
  draw.shading = shader_;
  const Material* const material =
      scene_.materials.empty() ? nullptr : &scene_.materials[raster::material_of(instance)];
  if (look_.blends &&
      (look_.opacity < 1 || instance.opacity < 1 ||
       (scalars.colors() != nullptr ? is_translucent(scalars, material)
                                    : is_translucent(*geometry, instance, material, threads))))
    draw.flags |= raster::kTranslucent;
  if (material != nullptr && material->alpha_mode == AlphaMode::mask) {
    draw.flags |= raster::kTested;
    draw.test = &shader_;
  }
  return true;
}

}  // namespace rastrum
