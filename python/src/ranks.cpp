// SPDX-License-Identifier: BSD-3-Clause
#include "ranks.hpp"

#include <array>
#include <optional>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include <nanobind/stl/array.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/string_view.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <rastrum/stop.hpp>

#include "frame_renderer.hpp"
#include "outputs.hpp"
#include "scenes.hpp"

namespace rastrum::python {
namespace {

// PyBUF_READ and PyBUF_WRITE: values of the stable ABI, whose headers have them from 3.11 on.
constexpr int kRead = 0x100, kWrite = 0x200;

/// The frame's memory as Python sees it, until the view is released.
class View {
 public:
  explicit View(std::span<std::byte> bytes) : View(bytes.data(), bytes.size(), kWrite) {}
  explicit View(std::span<const std::byte> bytes)
      : View(const_cast<std::byte*>(bytes.data()), bytes.size(), kRead) {}
  View(View&&) = default;
  View& operator=(View&&) = delete;
  View(const View&) = delete;
  View& operator=(const View&) = delete;
  ~View() {
    // A released view that Python code has kept reads no freed memory. A buffer taken from it
    // cannot be taken back.
    if (view_.is_valid() && !PyErr_Occurred()) {
      PyObject* const done = PyObject_CallMethod(view_.ptr(), "release", nullptr);
      if (done == nullptr) PyErr_Clear();
      Py_XDECREF(done);
    }
  }
  [[nodiscard]] const nb::object& get() const { return view_; }

 private:
  View(std::byte* data, std::size_t size, int flags) {
    static std::byte nothing{};
    view_ = nb::steal(PyMemoryView_FromMemory(reinterpret_cast<char*>(size == 0 ? &nothing : data),
                                              static_cast<Py_ssize_t>(size), flags));
    if (!view_.is_valid()) throw nb::python_error();
  }
  nb::object view_;
};

template <class T>
View view_of(std::span<T> values) {
  if constexpr (std::is_const_v<T>)
    return View(std::as_bytes(values));
  else
    return View(std::as_writable_bytes(values));
}

template <class Spans>
std::pair<std::vector<View>, nb::list> views_of(const Spans& spans) {
  std::pair<std::vector<View>, nb::list> views;
  views.first.reserve(spans.size());
  for (const auto& span : spans) views.second.append(views.first.emplace_back(view_of(span)).get());
  return views;
}

}  // namespace

PythonRanks::PythonRanks(nb::object ranks)
    : ranks_(std::move(ranks)),
      rank_(nb::cast<int>(ranks_.attr("rank"))),
      size_(nb::cast<int>(ranks_.attr("size"))) {
  if (size_ < 1 || rank_ < 0 || rank_ >= size_)
    throw Error(Errc::invalid_argument, "comm: says that it is rank " + std::to_string(rank_) +
                                            " of " + std::to_string(size_));
}

void PythonRanks::begin_phase(std::string_view name) {
  const nb::gil_scoped_acquire lock;
  ranks_.attr("begin_phase")(name);
}

std::uint64_t PythonRanks::max(std::uint64_t value) {
  const nb::gil_scoped_acquire lock;
  return nb::cast<std::uint64_t>(ranks_.attr("max")(value));
}

void PythonRanks::broadcast(std::span<std::byte> bytes, int root) {
  const nb::gil_scoped_acquire lock;
  const View view = view_of(bytes);
  ranks_.attr("broadcast")(view.get(), root);
}

void PythonRanks::exchange_sizes(std::span<const std::uint64_t> to, std::span<std::uint64_t> from) {
  const nb::gil_scoped_acquire lock;
  const View out = view_of(to), in = view_of(from);
  ranks_.attr("exchange_sizes")(out.get(), in.get());
}

void PythonRanks::exchange(std::span<const std::span<const std::byte>> to,
                           std::span<const std::span<std::byte>> from) {
  const nb::gil_scoped_acquire lock;
  const auto out = views_of(to);
  const auto in = views_of(from);
  ranks_.attr("exchange")(out.second, in.second);
}

namespace {

WordExchange exchange_named(const std::string& wanted) {
  for (const WordExchange e : {WordExchange::automatic, WordExchange::sparse,
                               WordExchange::two_hops, WordExchange::shared})
    if (wanted == name(e)) return e;
  throw Error(Errc::invalid_argument,
              "exchange: there is no " + wanted + "; take automatic, sparse, two_hops or shared");
}

/// From mpi.py, for this rank's part of a picture.
struct RanksFrame {
  RanksOptions options;
  std::vector<std::uint64_t> parts;
  bool has_materials = false;  ///< on some rank
};

/// The statistics, or None on all ranks if the frame was stopped.
nb::object render_parts(FrameRenderer& renderer, const nb::object& of, const ArrayScene& scene,
                        const Camera& camera, const FrameOptions& o,
                        const std::map<std::string, Output>& outputs, const RanksFrame& ranks,
                        const Annotations* annotations, const DeferredInterrupt& interrupt) {
  PythonRanks communicator(of);
  // These may fail on one rank alone, by its own arrays, so ranks agree on failures.
  ArrayScene::Shown shown;
  std::vector<Wanted> all;
  do_alike(communicator, "look at arrays", [&] {
    shown = scene.show(ranks.has_materials);
    all = wanted(outputs, 1, o, 0);
  });
  Targets targets;
  for (const Wanted& w : all) w.kind->attach(targets, w.array, 0, o);
  RanksStats stats;
  try {
    const nb::gil_scoped_release unlock;
    const StopToken stop = interrupt.token();
    stats = annotations == nullptr
                ? rastrum::render_parts(communicator, renderer.alone(), shown.view, ranks.parts,
                                        camera, o, targets, ranks.options, stop)
                : rastrum::render_parts(communicator, renderer.alone(), renderer.annotator(),
                                        shown.view, ranks.parts, camera, o, *annotations, targets,
                                        ranks.options, stop);
  } catch (const Stopped&) {
    return nb::none();
  }
  nb::dict d;
  d["exchange"] = std::string(name(stats.exchange));
  d["primitives"] = stats.primitives;
  d["words"] = stats.words;
  d["won"] = stats.won;
  d["fragments"] = stats.fragments;
  d["bands"] = stats.bands;
  return d;
}

Camera fit_of_ranks(const nb::object& of, const ArrayScene& scene,
                    const std::array<double, 3>& direction, const std::array<double, 3>& up,
                    double fov, bool orthographic, int width, int height,
                    const Annotations* annotations) {
  PythonRanks communicator(of);
  ArrayScene::Shown shown;
  do_alike(communicator, "look at arrays", [&] { shown = scene.show(); });
  const Camera along{.eye = {},
                     .target = {direction[0], direction[1], direction[2]},
                     .up = {up[0], up[1], up[2]},
                     .fov_rad = static_cast<float>(fov * 3.14159265358979323846 / 180),
                     .orthographic = orthographic};
  const nb::gil_scoped_release unlock;
  FitOfRanks fit(communicator);
  const Camera fitted = fit_picture(shown.view, along, width, height, {.ranks = &fit});
  if (annotations == nullptr) return fitted;
  Bounds box;
  if (annotations->bounds) box = bounds_of_ranks(communicator, shown.view);
  return with_room(*annotations, fitted, box, width, height);
}

std::tuple<double, double, double, double> ball_of_ranks(const nb::object& of,
                                                         const ArrayScene& scene) {
  PythonRanks communicator(of);
  ArrayScene::Shown shown;
  do_alike(communicator, "look at arrays", [&] { shown = scene.show(); });
  const nb::gil_scoped_release unlock;
  FitOfRanks fit(communicator);
  const BoundingSphere b = bounding_sphere(shown.view, &fit);
  return {b.centre.x, b.centre.y, b.centre.z, b.radius};
}

}  // namespace

void bind_ranks(nb::module_& m) {
  using nb::arg;
  nb::class_<DeferredInterrupt>(m, "DeferredInterrupt")
      .def(nb::init<>())
      .def("__enter__",
           [](nb::object self) {
             nb::cast<DeferredInterrupt&>(self).enter();
             return self;
           })
      .def("__exit__", [](DeferredInterrupt& self, const nb::args&) { self.exit(); })
      .def("raise_", &DeferredInterrupt::raise);
  nb::class_<RanksFrame>(m, "RanksFrame")
      .def(
          "__init__",
          [](RanksFrame* self, int root, const std::string& exchange, std::uint64_t fragment_bytes,
             std::vector<std::uint64_t> parts, bool has_materials) {
            new (self) RanksFrame{
                {root, exchange_named(exchange), fragment_bytes}, std::move(parts), has_materials};
          },
          arg("root"), arg("exchange"), arg("fragment_bytes"), arg("parts"), arg("has_materials"));
  m.def("render_parts", render_parts, arg("renderer"), arg("ranks"), arg("scene"), arg("camera"),
        arg("frame"), arg("outputs"), arg("options"), arg("annotations").none(), arg("interrupt"));
  m.def("ball_of_ranks", ball_of_ranks, arg("ranks"), arg("scene"));
  m.def("fit_of_ranks", fit_of_ranks, arg("ranks"), arg("scene"), arg("direction"), arg("up"),
        arg("fov"), arg("orthographic"), arg("width"), arg("height"), arg("annotations").none());
  m.def(
      "lights_of_ranks",
      [](const nb::object& of, const std::vector<Light>& own) {
        PythonRanks communicator(of);
        return lights_of_ranks(communicator, own);
      },
      arg("ranks"), arg("own"));
}

}  // namespace rastrum::python
