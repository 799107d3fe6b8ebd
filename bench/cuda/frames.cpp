// SPDX-License-Identifier: BSD-3-Clause
// `rastrum bench cuda-frames`: frames of real meshes on a GPU beside the threads', opaque and
// translucent, with arrays and picture in its memory and in the host's. Every picture is first
// compared with the threads', bit by bit.
#include <cstdio>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <bench/registry.hpp>
#include <bench/report.hpp>
#include <bench/scenes.hpp>
#include <bench/stand_ins.hpp>
#include <bench/tables/document.hpp>
#include <bench/tables/options.hpp>
#include <rastrum/render.hpp>

#include "device.hpp"
#include "rates.hpp"

namespace rastrum::bench {
namespace {

struct Look {
  const char* name;
  Shader shader;
  float opacity;
};
constexpr Look kLooks[] = {{"flat", Shader::flat, 1},
                           {"phong", Shader::phong, 1},
                           {"phong, opacity 0.3", Shader::phong, 0.3F}};

constexpr std::string_view kScenes[] = {"bunny", "dragon", "brain", "bunny-4m", "bunny-17m"};

/// Used if there is no shared data.
constexpr std::string_view kShapes[] = {"torus-knot", "gyroid"};

/// One renderer, and the memory of its mesh and picture.
class Frames {
 public:
  Frames(const TableOptions& options, Device device, const MeshView& mesh)
      : renderer_({.device = device, .threads = options.threads}), mesh_(mesh) {}

  /// Moves arrays and picture to the device's memory.
  void go_there(const Mesh& mesh, int width, int height) {
    there_.emplace(
        mesh, sizeof(Rgba8) * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    mesh_ = {};
    mesh_.positions = there_->positions.view();
    mesh_.normals.values = there_->normals.view();
    mesh_.indices = there_->indices.view();
  }

  void draw(const Camera& camera, const FrameOptions& frame, Image<Rgba8>& image) {
    const InstanceView instance{mesh_};
    const SceneView scene{.instances = {&instance, 1}};
    if (!there_) {
      stats_ = renderer_.render(scene, camera, frame, {.color8 = image});
      return;
    }
    const ImageView<Rgba8> there{static_cast<Rgba8*>(there_->picture.data()), frame.width,
                                 frame.height, frame.width};
    stats_ = renderer_.render_in_place(scene, camera, frame, {.color8 = there});
  }
  /// Copies draw()'s picture from the device's memory if it is there.
  void read(Image<Rgba8>& image) const {
    if (there_) there_->picture.read(image.pixels().data(), image.pixels().size_bytes());
  }
  [[nodiscard]] const FrameStats& stats() const { return stats_; }

 private:
  struct There {
    DeviceArray<Vec3> positions, normals;
    DeviceArray<std::uint32_t> indices;
    DeviceMemory picture;

    There(const Mesh& mesh, std::size_t picture_bytes)
        : positions(std::span<const Vec3>(mesh.positions)),
          normals(std::span<const Vec3>(mesh.normals.values)),
          indices(std::span<const std::uint32_t>(mesh.indices)),
          picture(picture_bytes) {}
  };

  Renderer renderer_;
  MeshView mesh_;
  std::optional<There> there_;
  FrameStats stats_;
};

}  // namespace

int run_cuda_frames(std::span<const std::string_view> arguments) {
  TableOptions options;
  std::string only;
  OptionParser parser("cuda-frames", "Frames of meshes on a GPU at 1920 × 1080.");
  parser.add_option("--scene", only, "run only this scene: one of `bench peers`, or bunny-17m")
      ->type_name("NAME");
  options.device = Device::cuda;
  if (const auto status = options.read(parser, arguments)) return *status;

  FrameOptions frame = options.frame(1920, 1080);
  const MachineLimits limits = measure_device(options);
  Document document = options.document("cuda-frames", "Frames of meshes on a GPU");
  document.notes.push_back(device_note(options, limits));
  document.notes.push_back(
      options.here(frame) +
      ", the whole mesh in view. `cuda` has arrays that it keeps from frame to frame and copies "
      "the "
      "picture back; in place both lie in its memory. All pictures are the threads', bit for bit.");
  Grid grid{"",
            {"mesh", "10³ triangles", "look", "threads ms", "cuda ms", "in place ms",
             "threads ÷ cuda", "threads ÷ in place", "floor ms", "10⁶ triangles/s in place"},
            {}};
  Grid stages{"Stages, ms", {"mesh", "look", "cuda", "in place"}, {}};
  Plot plot = options.plot(document, "mesh", "ms");
  for (const Look& look : kLooks)
    plot.panels.push_back({look.name, {{"threads", {}, 0}, {"cuda", {}, 1}, {"in place", {}, 2}}});

  std::vector<std::string_view> names;
  if (!only.empty()) {
    names.push_back(only);
  } else {
    for (const std::string_view name : kScenes)
      if (available(scene_by_name(name))) names.push_back(name);
    if (names.empty()) names.assign(std::begin(kShapes), std::end(kShapes));
    if (options.quick) names.resize(1);
  }
  bool right = true;
  for (const std::string_view name : names) {
    const Mesh mesh = load(scene_by_name(name));
    const Camera camera = whole_view(mesh);
    plot.places.emplace_back(name);
    for (std::size_t l = 0; l < std::size(kLooks); ++l) {
      const Look& look = kLooks[l];
      progress(std::string(name) + ", " + look.name);
      frame.shader = look.shader;
      frame.opacity = look.opacity;
      Frames threads(options, Device::threads, mesh.view());
      Frames copied(options, Device::cuda, mesh.view());
      Frames in_place(options, Device::cuda, mesh.view());
      in_place.go_there(mesh, frame.width, frame.height);
      Image<Rgba8> expected(frame.width, frame.height), image(frame.width, frame.height);
      threads.draw(camera, frame, expected);
      std::vector<Contender> contenders{{"threads", [&] { threads.draw(camera, frame, image); }}};
      bool equal_here = true;
      for (Frames* f : {&copied, &in_place}) {
        const char* way = f == &copied ? "cuda" : "in place";
        f->draw(camera, frame, image);
        f->read(image);
        if (f->stats().device != Device::cuda) {
          std::fprintf(stderr, "%s: left to the CPU: %s\n", way, f->stats().device_why.c_str());
          equal_here = false;
        } else if (!same_bits(image, expected)) {
          std::fprintf(stderr, "%s: another picture\n", way);
          equal_here = false;
        }
        contenders.push_back(
            {way, [f, &camera, &frame, &image] { f->draw(camera, frame, image); }});
      }
      right = right && equal_here;
      if (!equal_here) {
        for (auto& series : plot.panels[l].series) series.values.push_back(kGap);
        continue;
      }
      const std::vector<Timing> t = measure_interleaved(contenders, options.plan());
      const std::size_t triangles = mesh.triangle_count();
      const double ms = t[2].median_ms();
      const double floor = floor_ms(
          triangles,
          static_cast<std::uint64_t>(frame.width) * static_cast<std::uint64_t>(frame.height),
          limits, mesh.positions.size());
      grid.rows.push_back({std::string(name), std::to_string(triangles / 1000), look.name,
                           significant(t[0].median_ms()), significant(t[1].median_ms()),
                           significant(ms), significant(median_ratio(t[0], t[1])),
                           significant(median_ratio(t[0], t[2])), significant(floor),
                           significant(static_cast<double>(triangles) / ms / 1e3)});
      stages.rows.push_back({std::string(name), look.name, times_text(stages_ms(copied.stats())),
                             times_text(stages_ms(in_place.stats()))});
      for (std::size_t i = 0; i < t.size(); ++i)
        plot.panels[l].series[i].values.push_back(t[i].median_ms());
      document.figures.push_back({{"mesh", name},
                                  {"look", look.name},
                                  {"triangles", triangles},
                                  {"threads", to_json(t[0])},
                                  {"cuda", to_json(t[1])},
                                  {"in_place", to_json(t[2])},
                                  {"floor_ms", floor}});
    }
  }
  document.grids.push_back(std::move(grid));
  document.grids.push_back(std::move(stages));
  document.plot = std::move(plot);
  publish(document, options.out);
  return right ? 0 : 1;
}

}  // namespace rastrum::bench
