// SPDX-License-Identifier: BSD-3-Clause
#include "mesh_subject.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <utility>

#include <rastrum/error.hpp>

#include "frame/heatmap.hpp"
#include "frame/pictures.hpp"
#include "job/progress.hpp"
#include "same_picture.hpp"

namespace rastrum::cli::window {
namespace {

constexpr KeyHelp kMeshSubjectKeys[] = {{"m", "next shader (with Shift: the one before, as below)"},
                                        {"n", "next rasterizer"},
                                        {"v", "next visibility"},
                                        {"t", "next transparency"},
                                        {"o, l", "more, less opacity"},
                                        {"b", "next number of samples"},
                                        {"h", "heat map"}};

std::string text(const char* format, double value) {
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, format, value);
  return buffer;
}

std::vector<std::pair<std::string, std::string>> rows(const FrameStats& s) {
  const auto count = [](std::uint64_t n) { return std::to_string(n); };
  std::vector<std::pair<std::string, std::string>> r{
      {"rasterizer", s.rasterizer + ", " + s.visibility},
      {"why", s.why},
      {"triangles", count(s.triangles.input)},
      {"drawn", count(s.triangles.drawn)},
      {"culled", count(s.triangles.culled)},
      {"clipped", count(s.triangles.clipped)},
      {"dropped", count(s.triangles.dropped)},
      {"fragments", count(s.fragments)},
      {"layers a pixel", s.pixels_covered == 0
                             ? "0"
                             : text("%.2f", static_cast<double>(s.fragments) /
                                                static_cast<double>(s.pixels_covered))},
      {"scratch", text("%.1f MiB", static_cast<double>(s.peak_bytes) / (1 << 20))}};
  for (const auto& [name, value] : s.counters) r.emplace_back(name, count(value));
  std::erase_if(r, [](const auto& row) { return row.second.empty(); });
  return r;
}

/// The element after `now` in a ring, or before it with `back`; the first if `now` is missing.
template <class T>
T next(const std::vector<T>& ring, const T& now, bool back) {
  const auto found = std::ranges::find(ring, now);
  if (found == ring.end()) return ring.front();
  const auto i = static_cast<std::size_t>(found - ring.begin());
  return ring[(i + (back ? ring.size() - 1 : 1)) % ring.size()];
}

/// Throws UsageError if files lack the lights that are asked for.
void check_file_lights(const SceneArguments& a, const Scene& scene) {
  std::vector<Light> all = a.render.lights;
  if (a.lights.of_files) add_file_lights(scene, all);
}

}  // namespace

LoadedScene::LoadedScene(Inputs inputs)
    : scene(std::move(inputs.scene)),
      has_materials(inputs.has_materials),
      binding(scene),
      sphere(bounding_sphere(binding.view())),
      box(bounds(binding.view())),
      scalars(scalar_summaries(scene)) {
  const double low[] = {box.min.x, box.min.y, box.min.z};
  const double high[] = {box.max.x, box.max.y, box.max.z};
  constexpr const char* kNames[] = {"x", "y", "z"};
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (std::ranges::find(scalars, kNames[axis], &ScalarSummary::name) == scalars.end())
      scalars.push_back({kNames[axis], 0, {low[axis], high[axis]}, 0});
  const Vec3d across = Vec3d(box.max) - Vec3d(box.min);
  scalars.push_back({"distance", 0, {0, length(across) / 2}, 0});
}

void LoadedScene::show(const ScalarOptions& wanted, std::uint64_t version) {
  if (version == shown_) return;
  if (wanted.name.empty())
    scene.scalar_mappings.clear();
  else
    set_scalars(wanted, scene);
  binding = SceneBinding(scene);
  shown_ = version;
}

std::shared_ptr<LoadedScene> load_scene(const SceneArguments& a) {
  Timeline timeline;
  Progress progress(true);
  Inputs inputs = load_inputs(a.inputs, a.normals, timeline, progress, a.reading);
  set_sizes(inputs.scene, a.sizes);
  return std::make_shared<LoadedScene>(std::move(inputs));
}

/// Keeps the renderer until its options or its row change.
class MeshSubject::Painter {
 public:
  /// With the numbers that `notes` show.
  static SceneView view(LoadedScene& scene, const AnnotationOptions& notes, std::uint64_t version) {
    scene.show(notes.scalars, version);
    return scene.binding.view();
  }
  Annotator& annotator(const RendererOptions& options) {
    if (!annotator_ || annotator_threads_ != options.threads)
      annotator_.emplace(annotator_threads_ = options.threads, options.isa);
    return *annotator_;
  }
  Renderer& get(const RendererOptions& options, const family::Row& row) {
    if (!renderer_ || options_ != options || row_ != row) {
      renderer_.reset();
      renderer_.emplace(family::make_renderer(options, row));
      options_ = options;
      row_ = row;
    }
    return *renderer_;
  }

 private:
  std::optional<Renderer> renderer_;
  RendererOptions options_;
  family::Row row_;
  std::optional<Annotator> annotator_;
  int annotator_threads_ = 0;
};

MeshSubject::MeshSubject(SceneArguments arguments, std::shared_ptr<LoadedScene> scene)
    : KeyedSubject(MeshControl(Camera{}, {}, true), {}, kMeshSubjectKeys),
      painter_(std::make_shared<Painter>()) {
  settings_.render = arguments.render;
  settings_.notes = arguments.annotations;
  settings_.map = said(arguments.given, "--cmap", settings_.map);
  check_file_lights(arguments, scene->scene);
  show(std::move(arguments), std::move(scene));
}

MeshSubject::~MeshSubject() = default;

void MeshSubject::show(SceneArguments arguments, std::shared_ptr<LoadedScene> scene) {
  const ViewOptions& v = arguments.view;
  Camera camera = choose_camera(v, scene->scene, scene->binding.view(),
                                {arguments.render.width, arguments.render.height});
  if (v.leaves_room())
    camera = with_room(meant(settings_.notes), camera, scene->binding.view(),
                       arguments.render.width, arguments.render.height);
  settings_.file_lights = scene->scene.lights;
  settings_.adds_file_lights = arguments.lights.of_files;
  arguments_ = std::move(arguments);
  scene_ = std::move(scene);
  base_version_ = version() + 1;
  control_ = MeshControl(camera, scene_->sphere,
                         !arguments_.view.near_plane && !arguments_.view.file_camera);
  control_.resize(width_, height_);
  ++settings_version_;
}

std::uint64_t MeshSubject::version() const {
  return base_version_ + KeyedSubject::version();
}

void MeshSubject::handle(const Event& event) {
  if (is_command(event)) return change(event.key[0], event.shift);
  control_.handle(event);
}

void MeshSubject::change(char key, bool back) {
  Settings s = settings_;
  family::Options& r = s.render;
  switch (key) {
    case 'm':
      // From the visible one.
      r.shader = shader_from_name(
          next(shader_names(), name(shader_of(r.shader, scene_->has_materials)), back));
      break;
    case 'n':
      r.rasterizer = next(axis_names(family::rasterizer_axis()), r.rasterizer, back);
      break;
    case 'v':
      r.visibility = next(axis_names(family::visibility_axis()), r.visibility, back);
      break;
    case 't':
      parse_transparency(
          next(transparency_names(r.transparency), transparency_name(r.transparency), back),
          r.transparency);
      break;
    case 'o':
    case 'l':
      r.opacity = std::clamp(std::round(r.opacity * 20 + (key == 'o' ? 1 : -1)) / 20, 0.0F, 1.0F);
      break;
    case 'b':
      r.samples = next(kSampleCounts, r.samples, back);
      break;
    case 'h':
      s.heat_map = !s.heat_map;
      break;
    default:
      return;
  }
  set(std::move(s));
}

family::Options MeshSubject::options_for(int width, int height) const {
  family::Options options = settings_.frame(width, height);
  options.shader = shader_of(options.shader, scene_->has_materials);
  return options;
}

std::function<Picked()> MeshSubject::pick(int x, int y, int width, int height) {
  return [options = options_for(width, height), notes = settings_.notes,
          version = settings_version_, x, y, scene = scene_, camera = control_.camera(),
          painter = painter_]() -> Picked {
    Renderer& renderer = painter->get(options, options);
    const auto pick = renderer.pick(Painter::view(*scene, notes, version), camera, options, x, y);
    if (!pick) return {};
    const Vec3d& p = pick->position;
    Picked said;
    said.what = "instance " + std::to_string(pick->instance_id) + ", primitive " +
                std::to_string(pick->primitive);
    said.where =
        "(" + text("%.6g", p.x) + ", " + text("%.6g", p.y) + ", " + text("%.6g", p.z) + ")";
    if (pick->scalar && !notes.scalars.name.empty())
      said.value = notes.scalars.name + " = " + text("%.6g", *pick->scalar) +
                   (notes.scalars.bar_unit.empty() ? "" : " " + notes.scalars.bar_unit);
    return said;
  };
}

bool MeshSubject::has_glances() const {
  return settings_.render.samples != 1 || settings_.render.shadows || settings_.notes.occlusion ||
         settings_.notes.dome;
}

std::function<Drawn()> MeshSubject::draw(int width, int height, bool glance) {
  MeshSettings settings = settings_;
  family::Options frame = options_for(width, height);
  if (glance) {
    frame.samples = 1;
    frame.shadows = false;
    settings.notes.occlusion = settings.notes.dome = false;
  }
  return [options = frame, settings, version = settings_version_, scene = scene_,
          camera = control_.camera(), painter = painter_]() -> Drawn {
    Renderer& renderer = painter->get(options, options);
    const SceneView view = Painter::view(*scene, settings.notes, version);
    const Annotations notes = meant(settings.notes);
    Annotator& annotator = painter->annotator(options);
    Pictures pictures;
    Timeline timeline;
    Progress silent(true);
    const FrameStats stats = render_frames(renderer, view, camera, options,
                                           {.color8 = true,
                                            .overdraw = settings.heat_map,
                                            .images = {},
                                            .notes = &notes,
                                            .annotator = &annotator},
                                           false, 1, pictures, timeline, silent)
                                 .front();
    const double begin_ms = timeline.now_ms();
    annotate(pictures, notes, view, options, annotator);
    Figures figures{stats.frame_ms, stats.stages, rows(stats)};
    if (notes.any()) {
      figures.frame_ms += timeline.now_ms() - begin_ms;
      figures.stages.push_back({"effects", stats.frame_ms, figures.frame_ms});
    }
    Drawn drawn{std::move(pictures.color8), options.background.w == 1 || options.environment_behind,
                std::move(figures)};
    if (settings.heat_map) {
      Heatmap heat = make_heatmap(pictures.overdraw.view());
      drawn.image = std::move(heat.image);
      drawn.opaque = true;
      drawn.figures.rows.emplace_back("most fragments", std::to_string(heat.max));
    }
    return drawn;
  };
}

Subject::Texts MeshSubject::same_picture(int width, int height, const std::string& png) const {
  const Camera camera = control_.camera();
  MeshSettings settings = settings_;
  settings.render.shader = shader_of(settings.render.shader, scene_->has_materials);
  const ShownPicture shown{arguments_, settings, camera, width, height};
  return {{".sh", command_line(shown, png)}, {".py", python_lines(shown, png)}};
}

Worker::Job MeshSubject::open(const std::filesystem::path& file) {
  SceneArguments arguments = arguments_;
  arguments.inputs = {file.string()};
  // The camera's place does not fit another file.
  arguments.view.file_camera.reset();
  arguments.view.eye.reset();
  arguments.view.target.reset();
  arguments.view.near_plane.reset();
  arguments.view.far_plane.reset();
  arguments.view.orthographic_height.reset();
  return [this, arguments]() -> Worker::Done {
    auto scene = load_scene(arguments);
    return [this, arguments, scene] {
      // The other scene may lack the numbers, and sections were of the old one.
      ScalarOptions& s = settings_.notes.scalars;
      if (std::ranges::find(scene->scalars, s.name, &ScalarSummary::name) == scene->scalars.end()) {
        s.name.clear();
        s.bar_title.reset();
        s.given = nullptr;
      }
      settings_.sections = {};
      settings_.view_section = {};
      show(arguments, scene);
    };
  };
}

void MeshSubject::set_options(const std::string& options) {
  Parser app;
  SceneArguments changed;
  changed.render = settings_.render;
  changed.render.lights.clear();
  changed.annotations = settings_.notes;
  add_picture_options(app, changed);
  add_transparency_options(app, changed);
  add_machine_options(app, changed);
  add_annotation_options(app, changed.annotations);
  try {
    if (!app.parse(options)) return;  // --help
    check_annotations(changed.annotations, true);
    check_file_lights(changed, scene_->scene);
  } catch (const UsageError& e) {
    throw Error(Errc::invalid_argument, options + ": " + e.what());
  }
  Settings s = settings_;
  s.render = changed.render;
  s.notes = changed.annotations;
  if (changed.lights.given) {
    s.lights.clear();
    s.adds_file_lights = changed.lights.of_files;
  } else {
    s.render.lights = settings_.render.lights;
  }
  s.map = said(app.all_given(), "--cmap", s.map);
  say_again(app.all_given(), changed.lights, arguments_.given);
  set(std::move(s));
}

void MeshSubject::go_to(double time_s) {
  Camera camera = path_->at(time_s);
  if (!path_->first().has_planes && !arguments_.view.near_plane)
    place_planes(camera, scene_->sphere);
  control_.place(camera);
}

std::string MeshSubject::title() const {
  std::string names;
  for (const std::string& input : arguments_.inputs)
    names.append(names.empty() ? "" : ", ").append(input);
  return names;
}

std::span<const KeyHelp> MeshSubject::command_keys() {
  return kMeshSubjectKeys;
}

}  // namespace rastrum::cli::window
