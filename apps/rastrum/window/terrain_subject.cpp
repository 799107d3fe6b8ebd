// SPDX-License-Identifier: BSD-3-Clause
#include "terrain_subject.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <tuple>
#include <utility>

#include <rastrum/error.hpp>
#include <rastrum/family.hpp>
#include <rastrum/light.hpp>
#include <rastrum/on_terrain.hpp>

#include "job/ground.hpp"
#include "job/progress.hpp"
#include "same_terrain.hpp"

namespace rastrum::cli::window {
namespace {

using terrain::TerrainOptions;

constexpr KeyHelp kTerrainSubjectKeys[] = {
    {"1", "map or function"},      {"f1", "next map"}, {"b", "next filter"},
    {"c", "next kind of shadows"}, {"g", "fog"},       {"v", "fast, or paper 3's scans"},
    {"t", "next tiling"}};

/// A lit terrain depends on these beside its map, its numbers and the given lights.
auto light_key(const terrain::Light& l, const TerrainOptions& o, const std::string& lights,
               const ToneMapping& tone) {
  return std::make_tuple(l.sun.azimuth_deg, l.sun.elevation_deg, l.shadows, l.hill_shading,
                         l.ambient, l.sun_radius_deg, l.march.distance, l.march.steps, o.tiling,
                         o.filter == terrain::MapFilter::bilinear, o.classic, o.ground_clearance,
                         lights, tone.tone, tone.exposure_stops);
}

template <class T>
T next(T value, T last, bool back) {
  const int n = static_cast<int>(last) + 1;
  return static_cast<T>((static_cast<int>(value) + (back ? n - 1 : 1)) % n);
}

std::string name_of(const TerrainInput& input) {
  return input.height ? input.height->string() : input.function;
}

}  // namespace

/// Keeps the map, its light and the renderer between frames.
class TerrainSubject::Stage {
 public:
  /// Reads the map unless it is the current one.
  LoadedTerrain& map(const TerrainInput& input) {
    const std::string name = name_of(input);
    if (!source_ || name != name_) {
      lit_.reset();
      source_ = std::make_unique<LoadedTerrain>(input);
      if (!source_->scale_note().empty()) note(source_->scale_note());
      name_ = name;
    }
    return *source_;
  }
  void put(const TerrainInput& input, std::unique_ptr<LoadedTerrain> source) {
    lit_.reset();
    source_ = std::move(source);
    name_ = name_of(input);
  }
  /// The current map. Its heights are numbers if `s` says so and it has no colours.
  LitGround& lit(const Settings& s, const terrain::Light& light, const TerrainLook& o,
                 const TerrainInput& input, const terrain::TerrainCamera& camera) {
    const FrameOptions frame = s.frame();
    const auto key = light_key(light, o, s.lights, frame.tone);
    if (!lit_ || key != key_ || said_ != s.said) {
      lit_.reset();
      const ScalarOptions& numbers = s.shown.ground.heights;
      if (!numbers.name.empty() && !input.color) source_->show_numbers(numbers.mapping, o);
      lit_.emplace(*source_, o, light, frame, camera);
      key_ = key;
      said_ = s.said;
    }
    return *lit_;
  }
  terrain::TerrainRenderer& renderer(const terrain::TerrainRendererOptions& options) {
    if (!renderer_ || options_ != options) {
      renderer_.reset();
      renderer_.emplace(options);
      options_ = options;
    }
    return *renderer_;
  }

 private:
  std::string name_;
  std::unique_ptr<LoadedTerrain> source_;
  std::optional<LitGround> lit_;
  decltype(light_key({}, {}, {}, {})) key_;
  std::uint64_t said_ = 0;  ///< Settings::said
  std::optional<terrain::TerrainRenderer> renderer_;
  terrain::TerrainRendererOptions options_;
};

FrameOptions TerrainSettings::frame() const {
  FrameOptions seen = shown.frame;
  if (!lights.empty()) {
    seen.lights.clear();
    if (lights == "headlight") seen.lights = {headlight()};
    if (lights == "studio") seen.lights = light_kit();
    seen.environment_behind = false;
  }
  if (seen.lights.empty()) seen.tone = {};
  return seen;
}

TerrainSubject::TerrainSubject(const TerrainSceneArguments& arguments, const GroundShown& shown,
                               std::vector<TerrainInput> maps)
    : KeyedSubject(
          TerrainControl(TerrainPose{}),
          {arguments.options, arguments.light, arguments.sky_dims || arguments.dim_sky, shown},
          kTerrainSubjectKeys),
      maps_(std::move(maps)),
      stage_(std::make_shared<Stage>()) {
  TerrainPose home;
  home.camera = camera_of(arguments, stage_->map(maps_.front()));
  home.distance = arguments.options.distance;
  home.fov_rad = arguments.options.fov_rad;
  home.sun = arguments.light.sun;
  control_ = TerrainControl(home);
  resize(arguments.options.width, arguments.options.height);
}

TerrainSubject::~TerrainSubject() = default;

void TerrainSubject::next_map() {
  map_ = (map_ + 1) % maps_.size();
  ++settings_version_;
}

void TerrainSubject::handle(const Event& event) {
  if (is_command(event)) return change(event.key, event.shift);
  const bool was_moving = control_.moving();
  control_.handle(event);
  if (was_moving && event.kind == Event::Kind::move) place(control_.pose());
}

void TerrainSubject::advance(double dt_s) {
  const unsigned long before = control_.version();
  control_.advance(dt_s);
  if (control_.version() != before) place(control_.pose());
}

void TerrainSubject::place(const TerrainPose& pose) {
  control_.place(sayable(pose));
}

Subject::Texts TerrainSubject::same_picture(int width, int height, const std::string& png) const {
  const ShownTerrain shown{maps_[map_],
                           settings_.options,
                           settings_.light,
                           settings_.sky_dims,
                           settings_.shown,
                           settings_.lights,
                           settings_.frame(),
                           control_.pose(),
                           width,
                           height};
  return {{".sh", terrain_command_line(shown, png)}, {".py", terrain_python(shown, png)}};
}

void TerrainSubject::change(std::string_view key, bool back) {
  constexpr double kFogDensity = 0.002;  // half of the colour at 350 cells
  Settings s = settings_;
  TerrainOptions& o = s.options;
  if (key == "f1") return next_map();
  if (key == "1") {
    const bool map = maps_[map_].height.has_value();
    const auto other = std::find_if(maps_.begin(), maps_.end(), [&](const TerrainInput& m) {
      return m.height.has_value() != map;
    });
    if (other == maps_.end()) return;
    map_ = static_cast<std::size_t>(other - maps_.begin());
  } else if (key == "b") {
    o.filter = next(o.filter, terrain::MapFilter::mip, back);
  } else if (key == "c") {
    s.light.shadows = next(s.light.shadows, terrain::Shadows::soft, back);
  } else if (key == "g") {
    o.fog.density = o.fog.density > 0 ? 0 : kFogDensity;
  } else if (key == "v") {
    o.added = o.added == nullptr ? &family::terrain_words() : nullptr;
  } else if (key == "t") {
    o.tiling = next(o.tiling, terrain::Tiling::none, back);
  }
  set(std::move(s));
}

std::function<Drawn()> TerrainSubject::draw(int width, int height, bool /*glance*/) {
  const TerrainPose& pose = control_.pose();
  TerrainLook o = settings_.options;
  terrain::Light light = settings_.light;
  terrain::TerrainCamera camera = pose.camera;
  light.sun = pose.sun;
  o.distance = pose.distance;
  const FrameOptions frame = settings_.frame();
  if (frame.lights.empty()) o.sky = sky_of(o, light.sun, settings_.sky_dims);
  if (o.classic) {
    o.filter = terrain::MapFilter::none;
    if (o.tiling == terrain::Tiling::none) o.tiling = terrain::Tiling::repeat;
  } else {
    o.fov_rad = pose.fov_rad;
  }
  // Fewer pixels show the same, so values in pixels shrink with them. The original program's scale
  // is fixed, so it is always drawn in full.
  if (o.classic) {
    height = height_;
    width = width_;
  }
  const double shrunk = static_cast<double>(height) / height_;
  camera.horizon_px *= shrunk;
  o.scale_px *= shrunk;
  o.width = width;
  o.height = height;
  // Far ground in fog takes the colour behind it.
  if (frame.environment_behind) o.sky = horizon_color(frame.lights, frame.tone, camera);
  return [o, light, camera, frame, settings = settings_, input = maps_[map_],
          stage = stage_]() -> Drawn {
    terrain::TerrainRenderer& renderer = stage->renderer(o);
    const LoadedTerrain& source = stage->map(input);
    const GroundOptions& ground = settings.shown.ground;
    LitGround& lit = stage->lit(settings, light, o, input, camera);
    Drawn drawn{Image<Rgba8>(o.width, o.height), true, {}};
    Image<float> depth;
    terrain::TerrainTargets picture{.color8 = drawn.image};
    if (frame.environment_behind || ground.bounds) {
      depth = Image<float>(o.width, o.height);
      picture.depth = depth.view();
    }
    const auto begin = std::chrono::steady_clock::now();
    const terrain::TerrainStats s = renderer.render(lit.seen_from(camera), camera, o, picture);
    if (frame.environment_behind)
      draw_environment_behind(frame.lights, frame.tone, o, s.camera, picture,
                              o.device == Device::serial ? 1 : o.threads);
    draw_ground_annotations(meant(ground, source), lit.terrain(), numbers_of(ground, source), o,
                            s.camera, picture);
    const std::chrono::duration<double, std::milli> ms = std::chrono::steady_clock::now() - begin;
    const auto count = [](std::uint64_t n) { return std::to_string(n); };
    drawn.figures = {ms.count(),
                     s.stages,
                     {{"slices", count(s.slices)},
                      {"samples", count(s.samples)},
                      {"visible", count(s.visible)},
                      {"scratch", count(s.peak_bytes >> 10) + " KiB"},
                      {"position", count(static_cast<std::uint64_t>(std::abs(s.camera.x))) + ", " +
                                       count(static_cast<std::uint64_t>(std::abs(s.camera.y)))},
                      {"instructions", std::string(name(s.isa))}}};
    return drawn;
  };
}

Worker::Job TerrainSubject::open(const std::filesystem::path& file) {
  TerrainInput input;
  input.height = file;
  return [this, input, stage = stage_]() -> Worker::Done {
    stage->put(input, std::make_unique<LoadedTerrain>(input));
    return [this, input] {
      maps_.push_back(input);
      map_ = maps_.size() - 1;
      ++settings_version_;
    };
  };
}

void TerrainSubject::set_options(const std::string& options) {
  Parser app;
  TerrainSceneArguments changed;
  const TerrainPose& pose = control_.pose();
  changed.options = settings_.options;
  changed.options.distance = pose.distance;
  changed.options.fov_rad = pose.fov_rad;
  changed.light = settings_.light;
  changed.sky_dims = settings_.sky_dims;
  changed.light.sun = pose.sun;
  changed.input = maps_[map_];
  GroundShown shown = settings_.shown;
  std::vector<Light> lights = std::exchange(shown.frame.lights, {});
  LightChoice choice;
  shown.ground.heights.given = nullptr;
  add_terrain_picture(app, changed);
  add_terrain_light(app, changed);
  add_ground_lights(app, shown.frame, choice);
  add_ground_options(app, shown.ground);
  add_terrain_machine(app, changed);
  try {
    if (!app.parse(options)) return;  // --help
    if (!choice.given) shown.frame.lights = std::move(lights);
    check_ground(shown.ground, changed, shown.frame, choice, true,
                 [&app](const char* option) { return app.given(option); });
  } catch (const UsageError& e) {
    throw Error(Errc::invalid_argument, options + ": " + e.what());
  }
  TerrainPose now = pose;
  now.distance = changed.options.distance;
  now.fov_rad = changed.options.fov_rad;
  now.sun = changed.light.sun;
  control_.place(now);
  say_again(app.all_given(), choice, shown.given);
  Settings s = settings_;
  s.options = changed.options;
  s.light = changed.light;
  s.sky_dims = changed.sky_dims || changed.dim_sky;
  s.shown = std::move(shown);
  if (choice.given) s.lights.clear();
  ++s.said;
  set(std::move(s));
}

void TerrainSubject::go_to(double time_s) {
  TerrainPose pose = control_.pose();
  pose.camera = path_->at(time_s);
  control_.place(pose);
}

std::string TerrainSubject::title() const {
  return name_of(maps_[map_]);
}

std::span<const KeyHelp> TerrainSubject::command_keys() {
  return kTerrainSubjectKeys;
}

}  // namespace rastrum::cli::window
