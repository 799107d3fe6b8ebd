// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/render/target_checks.hpp>

#include <algorithm>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include <rastrum/core/number_text.hpp>
#include <rastrum/core/reject.hpp>
#include <rastrum/core/view_rows.hpp>
#include <rastrum/error.hpp>
#include <rastrum/raster/context/target_table.hpp>
#include <rastrum/raster/draws/shader_table.hpp>
#include <rastrum/raster/kernels/kernels.hpp>
#include <rastrum/render/scene_checks.hpp>

namespace rastrum {
namespace {

/// Calls f(view, name) for each target, whatever its pixels are.
template <class F>
void each_target(const Targets& t, const F& f) {
  raster::for_each_target([&](const auto& row) { f(t.*row.image, row.name); });
  for (const ImageView<Vec4>& extra : t.extra) f(extra, std::string_view("extra"));
}

struct NamedRows {
  ViewRows rows;
  std::string_view name;
};
std::vector<NamedRows> rows_of(const Targets& targets) {
  std::vector<NamedRows> all;
  each_target(targets, [&](const auto& view, std::string_view name) {
    if (!view.empty()) all.push_back({ViewRows::of(view), name});
  });
  return all;
}

/// Calls f(bytes, name) for each array that a geometry reads.
template <class F>
void each_array(GeometryRef geometry, const F& f) {
  if (const auto* const m = geometry.get_if<MeshView>()) {
    f(m->positions.reach(), "positions");
    f(m->indices.reach(), "indices");
    const auto attribute = [&](const auto& a, const char* name) {
      f(a.values.reach(), name);
      f(a.indices.reach(), name);
    };
    attribute(m->normals, "normals");
    attribute(m->texcoords, "texcoords");
    attribute(m->colors, "colors");
    f(m->face_materials.reach(), "face materials");
    f(m->faces.offsets.reach(), "offsets");
    f(m->scalars.values.reach(), "scalars");
    return;
  }
  geometry.visit([&](const auto& g) {
    if constexpr (requires { g.positions; }) f(g.positions.reach(), "positions");
    if constexpr (requires { g.centers; }) f(g.centers.reach(), "centers");
    if constexpr (requires { g.normals.reach(); }) f(g.normals.reach(), "normals");
    if constexpr (requires { g.colors.reach(); }) f(g.colors.reach(), "colors");
    if constexpr (requires { g.radii; }) f(g.radii.reach(), "radii");
    if constexpr (requires { g.sizes; }) f(g.sizes.reach(), "sizes");
    if constexpr (requires { g.indices; }) f(g.indices.reach(), "indices");
    if constexpr (requires { g.offsets; }) f(g.offsets.reach(), "offsets");
    if constexpr (requires { g.scalars.reach(); }) f(g.scalars.reach(), "scalars");
  });
}

constexpr std::uint64_t kMost32 = 0x7fffffff;

[[noreturn]] void refuse_narrow(const char* target, const std::string& why) {
  reject("the ", target, " target has 32 bits: ", why);
}

}  // namespace

void check_targets(const Targets& targets, const FrameOptions& o, bool whole) {
  for (const ImageView<Vec4>& extra : targets.extra)
    if (extra.data == nullptr) reject("an extra target is empty");
  each_target(targets, [&](const auto& view, std::string_view name) {
    check_size(view, o.width, o.height, std::string("the ").append(name) + " target");
  });
  if (!whole) return;
  const std::vector<NamedRows> all = rows_of(targets);
  for (std::size_t i = 0; i < all.size(); ++i)
    for (std::size_t k = 0; k < i; ++k)
      if (overlap(all[i].rows, all[k].rows))
        reject("the targets ", all[k].name, " and ", all[i].name,
               " overlap in memory; give each its own");
}

void check_apart(const Targets& targets, const InstanceRuns& runs) {
  const std::vector<NamedRows> all = rows_of(targets);
  const std::span<const InstanceView> instances = runs.firsts().instances;
  for (std::size_t i = 0; i < instances.size(); ++i) {
    if (i > 0 && instances[i].geometry == instances[i - 1].geometry) continue;
    each_array(instances[i].geometry, [&](std::span<const std::byte> bytes, const char* name) {
      for (const NamedRows& target : all)
        if (overlap(target.rows, ViewRows::of(bytes)))
          reject("instance ", runs.number(i), ": its ", name, " and the ", target.name,
                 " target overlap in memory; give each its own");
    });
  }
}

void check_band_rows(int rows) {
  if (rows < 0 || rows % raster::kBinSize != 0)
    reject("rows: ", rows, " rows at once; give a multiple of 64, or 0 for all of the picture");
}

void check_bands_taken(int rows, int height, bool taken) {
  if (rows != 0 && rows < height && !taken)
    reject("rows: the next rows would overwrite these; give take_rows, which takes them");
}

void check_loaded(ImageView<const std::uint64_t> held, std::uint64_t first_id,
                  parallel::Threads* threads) {
  const auto check_row = [&](std::size_t row) {
    const std::uint64_t* const keys = held.row(static_cast<int>(row));
    for (int x = 0; x < held.width; ++x)
      if (keys[x] != 0 && raster::id_of_key(keys[x]) >= first_id)
        reject("the keys target holds primitive ", raster::id_of_key(keys[x]), " at pixel (", x,
               ", ", row, "), but first_id says that the passes before have ", first_id,
               "; give the number of all of theirs");
  };
  parallel::for_each_index(threads, static_cast<std::size_t>(held.height), check_row, 16);
}

void check_outputs(const Targets& targets, bool has_scene, bool shades_materials) {
  if (!has_scene)
    raster::for_each_target([&](const auto& row) {
      if (row.needs_scene() && !(targets.*row.image).empty())
        throw Error(Errc::unsupported,
                    text_of("the ", row.name,
                            " target needs a scene's surfaces; a program returns its own values as "
                            "a further output (Targets::extra)"));
    });
  if (!targets.linear.empty() && !shades_materials)
    throw Error(Errc::unsupported,
                "the linear target needs the shader 'material': the others compute display values");
}

void check_ids(const Targets& targets, std::uint64_t first_id,
               std::span<const raster::Draw> draws) {
  if (targets.ids32.empty() && targets.primitives32.empty()) return;
  std::uint64_t primitives = first_id;
  for (const raster::Draw& d : draws) primitives += d.primitive_count;
  if (primitives > kMost32)
    refuse_narrow(targets.ids32.empty() ? "primitives32" : "ids32",
                  "there are " + std::to_string(primitives) + " primitives");
}

void check_instance_ids(const Targets& targets, const SceneView& scene) {
  if (targets.instances32.empty()) return;
  for (const InstanceView& i : scene.instances)
    if (i.id && *i.id != static_cast<std::int32_t>(*i.id))
      refuse_narrow("instances32", "an instance's id is " + std::to_string(*i.id));
}

void check_in_place(const SceneView& scene, const Targets& targets, Shader shader,
                    const FrameOptions& o) {
  const auto require = [](bool ok, std::string_view what) {
    if (!ok)
      throw Error(Errc::unsupported,
                  std::string("arrays in the device's memory (in_place): ").append(what));
  };
  const raster::ShaderRow& taken = raster::row_of(shader);
  require(taken.in_place,
          std::string("the shader ").append(taken.name).append(" needs them in the host's"));
  require(scene.materials.empty(), "materials need them in the host's");
  if (const std::string why = why_not_on_device(scene); !why.empty()) require(false, why);
  const auto is_host_only = [](const auto& row) { return !row.has_device(); };
  require(targets.extra.empty() && !raster::has_target(targets, is_host_only),
          "only the targets color8, color, depth, ids and keys can be filled");
  require(o.tone == ToneMapping{}, "only the CPU maps tones");
  require(o.lights.empty(), "only the CPU has lights of the frame");
  require(!o.environment_behind, "only the CPU draws an environment behind the picture");
  require(o.clip_planes.empty() &&
              std::ranges::all_of(scene.instances,
                                  [](const InstanceView& i) { return i.clip_planes.empty(); }),
          "clip planes need them in the host's");
}

void check_annotated(const Targets& targets) {
  if (targets.color8.empty() && targets.color.empty())
    reject("Annotations: are drawn into Targets::color8 or Targets::color; both are empty");
}

FrameOptions with_infinity(FrameOptions frame) {
  frame.no_distance = std::numeric_limits<float>::infinity();
  return frame;
}

void set_no_distance(const Targets& targets, float no_distance) {
  constexpr float kNothing = std::numeric_limits<float>::infinity();
  if (no_distance == kNothing) return;
  for (const ImageView<float>& image : {targets.view_depth, targets.distance})
    for (int y = 0; y < image.height && !image.empty(); ++y)
      std::replace(image.row(y), image.row(y) + image.width, kNothing, no_distance);
}

void check_over(const Targets& targets, const Pass& pass, const FrameOptions& o) {
  require(!targets.depth.empty(), "to draw over a picture, give the depth target with its depth");
  require(!pass.load,
          "a pass that loads keys cannot draw over a picture, too: the keys tell what is there");
  require(o.samples == 1, "a picture that is drawn over has one sample a pixel");
}

}  // namespace rastrum
