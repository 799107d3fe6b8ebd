// SPDX-License-Identifier: BSD-3-Clause
// Frames: options by name, arrays as targets; picking; triangles in clip space.
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <nanobind/stl/array.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <rastrum/io.hpp>
#include <rastrum/render.hpp>
#include <rastrum/stop.hpp>

#include "buffers.hpp"
#include "frame_renderer.hpp"
#include "outputs.hpp"
#include "rasterize.hpp"
#include "scenes.hpp"

namespace rastrum::python {
namespace {

using Numbers4 = std::array<double, 4>;

Cull cull_named(const std::string& name) {
  if (name == "none") return Cull::none;
  if (name == "back") return Cull::back;
  if (name == "front") return Cull::front;
  throw Error(Errc::invalid_argument, "cull: there is no " + name + "; take none, back or front");
}

Transparency transparency_named(const std::string& name) {
  if (name == "exact") return Transparency::exact;
  if (name == "unsorted") return Transparency::unsorted;
  if (name == "none") return Transparency::none;
  throw Error(Errc::invalid_argument,
              "transparency: there is no " + name + "; take exact, unsorted or none");
}

Tone tone_named(const std::string& name) {
  if (name == "none") return Tone::none;
  if (name == "reinhard") return Tone::reinhard;
  if (name == "aces") return Tone::aces;
  if (name == "neutral") return Tone::neutral;
  throw Error(Errc::invalid_argument,
              "tone: there is no " + name + "; take none, reinhard, aces or neutral");
}

template <class Enum>
Enum value_named(const char* what, const std::string& asked, std::initializer_list<Enum> all) {
  std::string names;
  for (const Enum value : all) {
    if (name(value) == asked) return value;
    names += (names.empty() ? "" : ", ") + std::string(name(value));
  }
  throw Error(Errc::invalid_argument,
              std::string(what) + ": there is no " + asked + "; take one of " + names);
}

FrameOptions frame(int width, int height, const std::string& shader, const std::string& cull,
                   const Numbers4& background, double opacity, const std::string& transparency,
                   int samples, const std::vector<Numbers4>& clip_planes,
                   const std::vector<Light>& lights, bool shadows, int shadow_size,
                   double shadow_distance, const std::string& tone, double exposure,
                   bool environment_behind) {
  FrameOptions o;
  o.no_distance = 0;  // as sensors have it
  o.width = width;
  o.height = height;
  o.shader = shader_from_name(shader);
  o.cull = cull_named(cull);
  o.background = {static_cast<float>(background[0]), static_cast<float>(background[1]),
                  static_cast<float>(background[2]), static_cast<float>(background[3])};
  o.opacity = static_cast<float>(opacity);
  o.transparency.method = transparency_named(transparency);
  o.samples = samples;
  for (const Numbers4& p : clip_planes) o.clip_planes.push_back({{p[0], p[1], p[2]}, p[3]});
  o.lights = lights;
  o.shadows = shadows;
  o.shadow_size = shadow_size;
  o.shadow_distance = shadow_distance;
  o.tone = {tone_named(tone), static_cast<float>(exposure)};
  o.environment_behind = environment_behind;
  check(o);
  return o;
}

nb::dict stats_of(const FrameStats& s) {
  nb::dict d, triangles;
  triangles["input"] = s.triangles.input;
  triangles["dropped"] = s.triangles.dropped;
  triangles["culled"] = s.triangles.culled;
  triangles["clipped"] = s.triangles.clipped;
  triangles["drawn"] = s.triangles.drawn;
  d["triangles"] = triangles;
  d["fragments"] = s.fragments;
  d["pixels_covered"] = s.pixels_covered;
  d["peak_bytes"] = s.peak_bytes;
  d["frame_ms"] = s.frame_ms;
  d["shader"] = s.shader;
  return d;
}

/// Draws again if a signal asked for a stop but Python's handler does not raise.
template <class Draw>
void interruptible(const Draw& draw) {
  for (;;) {
    const StopOnInterrupt interrupt;
    try {
      const nb::gil_scoped_release unlock;
      draw(interrupt.token());
      return;
    } catch (const Stopped&) {
    }
    if (PyErr_CheckSignals() != 0) throw nb::python_error();
  }
}

/// `scenes`: one for each camera, or one. `transforms`: (cameras, things, 4, 4) of float64.
nb::list render(FrameRenderer& renderer, const std::vector<const ArrayScene*>& scenes,
                const std::optional<Array>& transforms, const std::vector<Camera>& cameras,
                const FrameOptions& o, const std::map<std::string, Output>& outputs,
                const Annotations* annotations, const nb::object& progress) {
  ManyShown shown;
  std::uint64_t primitives = 0;
  for (const ArrayScene* const scene : scenes) {
    shown.scenes.push_back(scene->show());
    primitives = std::max(primitives, scene->primitive_count());
  }
  if (transforms) shown.transforms = doubles(*transforms);
  const std::vector<Wanted> all = wanted(outputs, cameras.size(), o, primitives);
  std::size_t done = 0;
  const auto after = [&](std::size_t count) {
    done += count;
    if (progress.is_none()) return;
    const nb::gil_scoped_acquire lock;
    progress(done, cameras.size());
  };
  std::vector<FrameStats> stats;
  interruptible([&](StopToken stop) {
    done = 0;
    stats = renderer.render(shown, cameras, o, all, annotations, stop, after);
  });
  nb::list result;
  for (const FrameStats& s : stats) result.append(stats_of(s));
  return result;
}

nb::object pick(FrameRenderer& renderer, const ArrayScene& scene, const Camera& camera,
                const FrameOptions& o, int x, int y) {
  const ArrayScene::Shown shown = scene.show();
  std::optional<Pick> p;
  {
    const nb::gil_scoped_release unlock;
    p = renderer.pick(shown.view, camera, o, x, y);
  }
  if (!p) return nb::none();
  nb::dict d;
  d["id"] = p->id;
  d["instance"] = p->instance_id;
  d["face"] = p->primitive;
  const double* const b = p->barycentrics.weight;
  d["barycentrics"] = nb::make_tuple(b[0], b[1], b[2]);
  d["position"] = nb::make_tuple(p->position.x, p->position.y, p->position.z);
  d["normal"] = nb::make_tuple(p->normal.x, p->normal.y, p->normal.z);
  d["depth"] = p->view_depth;
  d["distance"] = p->distance;
  d["scalar"] = p->scalar;
  return d;
}

/// out: (N, H, W, 4) of float32. A picture for each of `positions`; or for each of `ranges`, pairs
/// (first triangle, number of triangles), of the first.
void rasterize(FrameRenderer& renderer, const std::vector<Array>& positions, const Array& triangles,
               const std::vector<std::pair<std::uint64_t, std::uint64_t>>& ranges,
               const Output& out) {
  const IndexView corners = indices(triangles, "tri");
  std::vector<ClipTriangles> all;
  for (const Array& p : positions)
    all.push_back({values<Vec4>(p, "pos"), corners, 0, corners.size() / 3});
  if (!ranges.empty()) {
    all = std::vector<ClipTriangles>(ranges.size(), all.at(0));
    for (std::size_t i = 0; i < ranges.size(); ++i) {
      std::tie(all[i].first, all[i].count) = ranges[i];
      if (all[i].first > corners.size() / 3 || all[i].count > corners.size() / 3 - all[i].first)
        throw Error(Errc::invalid_argument, "ranges: row " + std::to_string(i) +
                                                " reaches beyond the " +
                                                std::to_string(corners.size() / 3) + " triangles");
    }
  }
  if (out.ndim() != 4 || out.dtype() != nb::dtype<float>() || out.shape(0) != all.size() ||
      out.shape(3) != 4)
    throw Error(Errc::invalid_argument,
                "out: must be (" + std::to_string(all.size()) + ", H, W, 4) of float32");
  const ImageView<Vec4> first{static_cast<Vec4*>(out.data()), static_cast<int>(out.shape(2)),
                              static_cast<int>(out.shape(1))};
  interruptible([&](StopToken stop) { renderer.rasterize(all, first, stop); });
}

void write_png(const std::string& file, const Array& pixels, int threads) {
  if (pixels.ndim() != 3 || pixels.shape(2) != 4 || pixels.dtype() != nb::dtype<std::uint8_t>() ||
      pixels.stride(2) != 1 || pixels.stride(1) != 4 ||
      pixels.shape(0) > static_cast<std::size_t>(kMaxImageSize) ||
      pixels.shape(1) > static_cast<std::size_t>(kMaxImageSize) || pixels.stride(0) % 4 != 0)
    throw Error(Errc::invalid_argument,
                "png: must be (H, W, 4) of uint8, with each row's pixels side by side");
  io::write_png(
      file,
      ImageView<const Rgba8>{static_cast<const Rgba8*>(pixels.data()),
                             static_cast<int>(pixels.shape(1)), static_cast<int>(pixels.shape(0)),
                             static_cast<std::ptrdiff_t>(pixels.stride(0) / 4)},
      threads);
}

/// An io::AtomicFile for Python's own writers, which use its descriptor.
class WholeFile {
 public:
  explicit WholeFile(const std::string& file) : file_(std::in_place, file) {}
  [[nodiscard]] int fileno() { return ::fileno(open().stream()); }
  void commit() {
    open().commit();
    file_.reset();
  }
  void abandon() { file_.reset(); }

 private:
  [[nodiscard]] io::AtomicFile& open() {
    if (!file_) throw Error(Errc::invalid_argument, "the file is already written or given up");
    return *file_;
  }
  std::optional<io::AtomicFile> file_;
};

}  // namespace

void bind_frames(nb::module_& m) {
  using nb::arg;
  nb::class_<FrameOptions>(m, "Frame")
      .def_ro("width", &FrameOptions::width)
      .def_ro("height", &FrameOptions::height);
  m.def("frame", frame, arg("width"), arg("height"), arg("shader"), arg("cull"), arg("background"),
        arg("opacity"), arg("transparency"), arg("samples"), arg("clip_planes"), arg("lights"),
        arg("shadows"), arg("shadow_size"), arg("shadow_distance"), arg("tone"), arg("exposure"),
        arg("environment_behind"));
  nb::class_<FrameRenderer>(m, "Renderer")
      .def(
          "__init__",
          [](FrameRenderer* self, int threads, std::uint64_t memory_limit,
             const std::string& device, const std::optional<std::string>& isa) {
            RendererOptions o;
            o.threads = threads;
            o.memory_limit = memory_limit;
            o.device =
                value_named("device", device,
                            {Device::serial, Device::threads, Device::cuda, Device::automatic});
            if (isa)
              o.isa = value_named(
                  "isa", *isa,
                  {Isa::scalar, Isa::sse4, Isa::avx2, Isa::avx512, Isa::neon, Isa::wasm});
            new (self) FrameRenderer(o);
          },
          arg("threads"), arg("memory_limit"), arg("device"), arg("isa").none())
      .def("render", render, arg("scenes"), arg("transforms").none(), arg("cameras"), arg("frame"),
           arg("outputs"), arg("annotations").none(), arg("progress").none())
      .def("pick", pick, arg("scene"), arg("camera"), arg("frame"), arg("x"), arg("y"))
      .def("rasterize", rasterize, arg("positions"), arg("triangles"), arg("ranges"), arg("out"));
  m.def("empty", empty, arg("shape"), arg("type"));
  m.def("shader_names", [] {
    std::vector<std::string> names;
    for (const std::string_view n : shader_names()) names.emplace_back(n);
    return names;
  });
  m.def("read_image", [](const std::string& file) {
    auto* const image = new Image<Rgba8>(io::read_image(file));
    const nb::capsule owner(image, [](void* p) noexcept { delete static_cast<Image<Rgba8>*>(p); });
    const std::size_t shape[] = {static_cast<std::size_t>(image->height()),
                                 static_cast<std::size_t>(image->width()), 4};
    return nb::ndarray<nb::numpy, std::uint8_t>(image->pixels().data(), 3, shape, owner);
  });
  nb::class_<WholeFile>(m, "AtomicFile")
      .def(nb::init<const std::string&>(), arg("file"))
      .def("fileno", &WholeFile::fileno)
      .def("commit", &WholeFile::commit)
      .def("abandon", &WholeFile::abandon);
  m.def("write_png", write_png, arg("file"), arg("pixels"), arg("threads") = 1,
        nb::call_guard<nb::gil_scoped_release>());
}

}  // namespace rastrum::python
