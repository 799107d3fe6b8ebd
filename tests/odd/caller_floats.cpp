// SPDX-License-Identifier: BSD-3-Clause
// Float modes and locales of a caller, or of libraries it links, change no bit.
#include <clocale>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <locale>
#include <span>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/annotate.hpp>
#include <rastrum/color.hpp>
#include <rastrum/digest.hpp>
#include <rastrum/environment.hpp>
#include <rastrum/fit.hpp>
#include <rastrum/io.hpp>
#include <rastrum/on_terrain.hpp>
#include <rastrum/out_of_core.hpp>
#include <rastrum/overlay.hpp>
#include <rastrum/pick.hpp>
#include <rastrum/ranks.hpp>
#include <rastrum/render.hpp>
#include <rastrum/shapes.hpp>
#include <rastrum/terrain_light.hpp>
#include <rastrum/transform.hpp>

#include "tests/io/dem_file.hpp"
#include "tests/io/files.hpp"
#include "tests/support/refused.hpp"
#include "tests/support/scenes.hpp"

#if defined(__x86_64__)
#include <xmmintrin.h>
#endif

namespace rastrum::test::caller_floats {
namespace {

/// The processor's register bits for rounding, traps and subnormal numbers.
std::uint64_t control() {
#if defined(__x86_64__)
  return _mm_getcsr() & 0xffc0U;  // without the flags
#else
  std::uint64_t fpcr = 0;
  asm volatile("mrs %0, fpcr" : "=r"(fpcr));
  return fpcr;
#endif
}
void set_control(std::uint64_t value) {
#if defined(__x86_64__)
  _mm_setcsr(static_cast<unsigned>(value));
#else
  asm volatile("msr fpcr, %0" : : "r"(value));
#endif
}

struct Mode {
  const char* name;
  std::uint64_t control;
};
std::vector<Mode> modes() {
#if defined(__x86_64__)
  return {{"upward", 0x5f80},          {"downward", 0x3f80},
          {"towards zero", 0x7f80},    {"all traps", 0x0000},
          {"flushed to zero", 0x9fc0}, {"upward, flushed, all traps", 0xc040}};
#else
  // Few ARM processors have traps.
  return {{"upward", 1U << 22},
          {"downward", 2U << 22},
          {"towards zero", 3U << 22},
          {"flushed to zero", 1U << 24},
          {"upward, flushed", (1U << 22) | (1U << 24)}};
#endif
}

/// Collects the bytes of all results.
class Log {
 public:
  template <class T>
  void add(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  void add(const Digest& d) { bytes_ += d.hex(); }
  void add(const std::string& s) { bytes_ += s; }
  void add(double x) { add(&x, sizeof x); }
  void add(Vec3d v) {
    for (const double x : {v.x, v.y, v.z}) add(x);
  }
  void add(const Camera& c) {
    add(Vec3d(c.eye));
    add(Vec3d(c.target));
    add(double{c.near_plane});
    add(double{c.orthographic_height});
    add(double{c.fov_rad});
  }
  template <class T>
  void all(const std::vector<T>& values) {
    add(values.data(), values.size() * sizeof(T));
  }
  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  void add(const void* data, std::size_t size) {
    bytes_.append(static_cast<const char*>(data), size);
  }
  std::string bytes_;
};

constexpr int kW = 96, kH = 64;

/// Coordinates whose squares are subnormal.
Scene tiny_scene() {
  Scene scene = single(shapes::torus_knot(2, 3, 40, 8));
  for (Vec3& p : scene.meshes[0].positions) p = p * 1e-25F;
  scene.meshes[0].normals = {};
  return scene;
}

struct Work {
  const char* name;
  std::function<void(Log&)> run;
};

std::span<const std::byte> bytes_of(const std::string& text) {
  return std::as_bytes(std::span(text));
}

/// A file of each text format, whose numbers have decimal points.
const std::vector<std::pair<const char*, std::string>>& text_files() {
  static const std::vector<std::pair<const char*, std::string>> all = {
      {"obj", "mtllib none.mtl\nv 0.1 0.25 -1.5e-3\nv 1.5 0 0 1.5 0 255\nv 0 1.75 0\nf 1 2 3\n"},
      {"off", "OFF\n3 1 0\n0.1 0.25 -1.5e-3\n1.5 0 0\n0 1.75 0\n3 0 1 2 0.5 1.5 255.5\n"},
      {"stl",
       "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0.1 0.25 -1.5e-3\nvertex 1.5 0 0\n"
       "vertex 0 1.75 0\nendloop\nendfacet\nendsolid\n"},
      {"ply",
       "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty double y\n"
       "property float z\nproperty float heat\nelement face 1\n"
       "property list uchar int vertex_indices\nend_header\n0.1 0.25 -1.5e-3 0.5\n"
       "1.5 0 0 1.25\n0 1.75 0 2.5\n3 0 1 2\n"},
      {"gltf",
       R"({"asset":{"version":"2.0"},"cameras":[{"type":"perspective","perspective":)"
       R"({"yfov":0.75,"znear":0.125}}],"nodes":[{"camera":0,"translation":[1.5,2.25e-1,3.125]}]})"}};
  return all;
}

/// Inputs are made in advance, because a caller's arithmetic runs in its own mode.
std::vector<Work> works() {
  std::vector<Work> all;
  Image<Vec3> light(64, 32);
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 64; ++x)
      light(x, y) = {static_cast<float>(x) / 3, static_cast<float>(y) / 7, 0.1F};
  Image<float> heights(64, 64);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) heights(x, y) = 20 * std::sin(static_cast<float>(x * y) / 100);
  for (const int threads : {1, 3}) {
    for (const Shader shader : {Shader::phong, Shader::material, Shader::normal})
      all.push_back({"Renderer", [=](Log& log) {
                       const Scene scene = single(shapes::torus_knot(2, 3, 60, 8));
                       const SceneBinding binding(scene);
                       const Camera camera = fit_picture(
                           binding.view(), fit_camera(binding.view(), 0.8F, false), kW, kH);
                       Renderer renderer({.threads = threads});
                       FrameOptions frame{.width = kW,
                                          .height = kH,
                                          .shader = shader,
                                          .opacity = 0.7F,
                                          .samples = threads == 1 ? 1 : 4,
                                          .lights = light_kit(),
                                          .shadows = true};
                       Image<Vec4> image(kW, kH);
                       Image<Vec3> positions(kW, kH);
                       renderer.render(binding.view(), camera, frame,
                                       {.color = image, .positions = positions});
                       log.add(digest(image));
                       log.add(digest(positions));
                       const auto seen = renderer.pick(binding.view(), camera, frame, 48, 20);
                       if (seen) {
                         log.add(seen->position);
                         log.add(seen->distance);
                       }
                     }});
    all.push_back({"a tiny scene", [threads, scene = tiny_scene()](Log& log) {
                     const SceneBinding binding(scene);
                     const Camera camera = fit_camera(binding.view(), 0.8F, false);
                     log.add(camera);
                     Image<Rgba8> image(kW, kH);
                     Renderer({.threads = threads})
                         .render(binding.view(), camera, {.width = kW, .height = kH},
                                 {.color8 = image});
                     log.add(digest(image));
                   }});
  }
  all.push_back({"shapes", [](Log& log) {
                   log.all(shapes::teapot(6).normals.values);
                   log.all(shapes::gyroid(12).positions);
                   log.all(shapes::hairball(20, 8).positions);
                   log.all(shapes::subdivide(shapes::sphere(6, 9), 2).positions);
                   log.all(shapes::spheres(40).radii);
                   log.all(shapes::from_spec("torus_knot?p=2").positions);
                 }});
  all.push_back({"normals", [](Log& log) {
                   const Mesh mesh = shapes::torus_knot(2, 3, 40, 8);
                   log.all(vertex_normals(mesh.positions, mesh.indices));
                   log.all(crease_normals(mesh.positions, mesh.indices, 30).values);
                   log.all(normal_lines(mesh.view(), 0.1F));
                 }});
  all.push_back({"cameras", [](Log& log) {
                   const Scene scene = single(shapes::torus_knot(2, 3, 60, 8));
                   const SceneBinding binding(scene);
                   const View view = turned(view_of(ViewName::iso, {0, 0, 1}),
                                            {.azimuth_deg = 33, .elevation_deg = 7});
                   const Camera camera =
                       fit_camera(binding.view(), 0.7F, false, view.direction, view.up);
                   log.add(zoomed(fit_picture(binding.view(), camera, kW, kH), 1.3));
                   log.add(fit_picture(binding.view(), camera, kW, kH, {.turns = true}));
                   for (const auto& row : world_to_clip(camera, kW, kH).m)
                     for (const double x : row) log.add(x);
                   log.add(view_distance(camera, 0.3F));
                   const Quaternion q = rotation_about({1, 2, 3}, 0.7);
                   log.add(slerp(q, rotation_about({3, 1, 2}, 1.1), 0.3).w);
                 }});
  all.push_back(
      {"scalars", [](Log& log) {
         const ScalarColors colors({.map = color_map("viridis"), .logarithmic = true}, {0.01, 70});
         for (const double x : {0.013, 0.1, 0.7, 1.9, 33.3}) log.add(colors(x));
       }});
  all.push_back({"environments and lights", [light](Log& log) {
                   const Environment around(light.view(), 2);
                   log.add(around.mean());
                   Image<Vec4> image(kW, kH);
                   const Scene scene = single(shapes::sphere());
                   const SceneBinding binding(scene);
                   FrameOptions frame{.width = kW,
                                      .height = kH,
                                      .shader = Shader::material,
                                      .lights = {{.kind = EnvironmentLight{.picture = around}}},
                                      .environment_behind = true};
                   frame.tone.tone = Tone::aces;
                   Renderer({.threads = 2})
                       .render(binding.view(), fit_camera(binding.view(), 0.8F, false), frame,
                               {.color = image});
                   log.add(digest(image));
                 }});
  all.push_back({"annotations", [](Log& log) {
                   const Scene scene = single(shapes::torus_knot(2, 3, 60, 8));
                   const SceneBinding binding(scene);
                   Annotations a;
                   a.occlusion.emplace();
                   a.dome.emplace();
                   a.silhouettes.emplace();
                   a.edges.emplace(EdgeLines{.angle_degrees = 20});
                   a.bounds = a.axes = true;
                   a.title = "title";
                   Image<Rgba8> image(2 * kW, 2 * kH);
                   Renderer renderer({.threads = 2});
                   Annotator(2).render(renderer, binding.view(),
                                       with_room(a, fit_camera(binding.view(), 0.8F, false),
                                                 binding.view(), 2 * kW, 2 * kH),
                                       {.width = 2 * kW, .height = 2 * kH}, a, {.color8 = image});
                   log.add(digest(image));
                 }});
  all.push_back({"terrain", [heights](Log& log) {
                   const terrain::HeightMap map{.heights = heights};
                   const auto lit = terrain::lit_colors(map, {});
                   log.add(digest(lit));
                   const terrain::Terrain ground = terrain::Terrain(map).with_colors(lit);
                   Image<Rgba8> image(kW, kH);
                   Image<float> depth(kW, kH);
                   terrain::TerrainOptions options{
                       .width = kW, .height = kH, .filter = terrain::MapFilter::bilinear};
                   terrain::TerrainRenderer({.threads = 2})
                       .render(ground, {.x = 30, .y = 60, .altitude = 40}, options,
                               {.color8 = image, .depth = depth});
                   log.add(digest(image));
                   log.add(digest(depth));
                   log.add(terrain::ground_at(ground, 3.3, 4.4, options));
                 }});
  all.push_back({"files", [](Log& log) {
                   // Made on the first call, in the ordinary mode, because std::filesystem computes
                   // too.
                   static const TempFolder folder;
                   static const auto ply = folder.path("b.ply");
                   static const auto obj = folder.write(
                       "a.obj", "v 0.1 0.2 0.3\nv 1.7 0.1234567 1e-3\nv 0.3 1.9 2e-1\nf 1 2 3\n");
                   log.all(io::read_scene(obj).meshes[0].positions);
                   io::write_ply(ply, shapes::torus_knot(2, 3, 60, 8));
                   const Scene scene = io::read_scene(ply);
                   log.add(io::describe(scene));
                   const OutOfCoreFile large(ply);
                   Image<Rgba8> image(kW, kH);
                   large.render(fit_camera(SceneBinding(scene).view(), 0.8F, false),
                                {.width = kW, .height = kH}, {.color8 = image}, {});
                   log.add(digest(image));
                 }});
  all.push_back({"texts", [](Log& log) {
                   for (const auto& [format, text] : text_files()) {
                     const Scene scene = io::decode_scene(bytes_of(text), format, "input");
                     log.add(io::describe(scene));
                     for (const Mesh& mesh : scene.meshes) log.all(mesh.positions);
                     for (const std::string& warning : scene.warnings) log.add(warning);
                   }
                   static const std::string file = dem({{0.5, 1.5, 2.5, {1, 2}}});
                   const io::HeightGrid grid = io::decode_heights(bytes_of(file), "dem", "input");
                   for (const float h : grid.heights.pixels()) log.add(h);
                 }});
  all.push_back(
      {"messages", [heights](Log& log) {
         Scene scene = single(shapes::sphere());
         scene.instances[0].opacity = 1.25F;
         const SceneBinding binding(scene);
         Image<Rgba8> image(kW, kH);
         log.add(refusal_of([&] {
           Renderer().render(binding.view(), {}, {.width = kW, .height = kH}, {.color8 = image});
         }));
         log.add(refusal_of([&] {
           const terrain::Terrain flat(terrain::HeightMap{.heights = heights});
           terrain::TerrainRenderer().render(
               flat, {}, {.width = kW, .height = kH, .distance = 1.5e8}, {.color8 = image});
         }));
         static const std::string rough =
             R"({"asset":{"version":"2.0"},"materials":[{"pbrMetallicRoughness":)"
             R"({"roughnessFactor":1.5}}]})";
         log.add(refusal_of(
             [&] { static_cast<void>(io::decode_scene(bytes_of(rough), "gltf", "rough")); },
             Errc::bad_format));
       }});
  all.push_back(
      {"ranks", [](Log& log) {
         const Scene scene = single(shapes::torus_knot(2, 3, 60, 8));
         Image<Rgba8> image(kW, kH);
         LocalRanks ranks(2);
         ranks.run([&](Communicator& communicator) {
           const SceneBinding binding(scene);
           const Camera camera = fit_camera(binding.view(), 0.8F, false);
           Renderer renderer({.threads = 1});
           const std::uint64_t part = static_cast<std::uint64_t>(communicator.rank());
           Targets targets;
           if (communicator.rank() == 0) targets.color8 = image;
           FrameOptions frame{.width = kW, .height = kH, .opacity = 0.5F};
           render_parts(communicator, renderer, binding.view(), {&part, 1}, camera, frame, targets);
         });
         log.add(digest(image));
       }});
  return all;
}

/// Runs `work` in a mode. Returns whether the mode is unchanged afterwards.
template <class Work>
void run_in(const Mode& mode, const Work& work) {
  const std::uint64_t before = control();
  set_control(mode.control);
  const std::uint64_t wanted = control();
  try {
    work();
  } catch (...) {
    const std::uint64_t after = control();
    set_control(before);
    EXPECT_EQ(after, wanted) << mode.name;
    throw;
  }
  const std::uint64_t after = control();
  set_control(before);
  EXPECT_EQ(after, wanted) << mode.name;
}

/// While it lives, numbers have a decimal comma: in C if localedef can make such a locale, and in
/// C++.
class CommaNumbers {
 public:
  CommaNumbers() {
    const auto source = folder_.write("source",
                                      "comment_char %\nescape_char /\nLC_NUMERIC\ndecimal_point "
                                      "\",\"\nthousands_sep \".\"\ngrouping 3;3\nEND LC_NUMERIC\n");
    // It warns about missing parts of the locale and returns an error, but the locale is made.
    (void)!std::system(("localedef -c --no-archive -i " + source.string() + " " +
                        folder_.path("comma").string() + " > /dev/null 2>&1")
                           .c_str());
    ::setenv("LOCPATH", folder_.path("").c_str(), 1);
    is_in_c_ = std::setlocale(LC_NUMERIC, "comma") != nullptr;
    std::locale::global(std::locale(std::locale::classic(), new Comma));
  }
  ~CommaNumbers() {
    std::locale::global(std::locale::classic());
    std::setlocale(LC_NUMERIC, "C");
    ::unsetenv("LOCPATH");
  }
  CommaNumbers(const CommaNumbers&) = delete;
  CommaNumbers& operator=(const CommaNumbers&) = delete;

  [[nodiscard]] bool is_in_c() const { return is_in_c_; }

 private:
  struct Comma : std::numpunct<char> {
    [[nodiscard]] char do_decimal_point() const override { return ','; }
    [[nodiscard]] char do_thousands_sep() const override { return '.'; }
    [[nodiscard]] std::string do_grouping() const override { return "\3"; }
  };
  TempFolder folder_;
  bool is_in_c_ = false;
};

}  // namespace

// A caller has set a locale whose numbers have a comma. Right: the same text, numbers and
// pictures (number_text.hpp).
TEST(OddLocale, OfTheCaller) {
  const std::vector<Work> all = works();
  std::vector<Log> right(all.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i].run(right[i]);
  const CommaNumbers comma;
  std::ostringstream stream;
  stream << 1234.5;
  ASSERT_EQ(stream.str(), "1.234,5");
  char text[8];
  std::snprintf(text, sizeof text, "%g", 1.5);
  ASSERT_EQ(std::string(text), comma.is_in_c() ? "1,5" : "1.5");
  for (std::size_t i = 0; i < all.size(); ++i) {
    Log log;
    all[i].run(log);
    EXPECT_EQ(log.bytes() == right[i].bytes(), true) << all[i].name;
  }
  if (!comma.is_in_c())
    GTEST_SKIP() << "no locale of C with a comma: localedef (Debian: libc-bin) made none";
}

// A caller rounds upward, traps, or flushes subnormal numbers. Right: the same bits, and the
// caller's mode as before (FloatScope).
TEST(OddFloats, OfTheCaller) {
  for (const Work& work : works()) {
    Log right;
    work.run(right);
    for (const Mode& mode : modes()) {
      Log log;
      run_in(mode, [&] { work.run(log); });
      EXPECT_EQ(log.bytes() == right.bytes(), true) << work.name << ", " << mode.name;
    }
  }
}

// The same where a call throws. Right: the caller's mode as before.
TEST(OddFloats, AfterAnError) {
  for (const Mode& mode : modes()) {
    const Scene scene = single(shapes::sphere());
    const SceneBinding binding(scene);
    const Camera camera = fit_camera(binding.view(), 0.8F, false);
    Renderer renderer({.threads = 2});
    const auto wrong = [&] {
      run_in(mode, [&] {
        renderer.render(binding.view(), camera, {.width = kW, .height = kH, .samples = 3}, {});
      });
    };
    EXPECT_THROW(wrong(), Error);
    const auto no_scene = [&] { run_in(mode, [] { (void)io::read_scene("none.ply"); }); };
    EXPECT_THROW(no_scene(), Error);
  }
}

}  // namespace rastrum::test::caller_floats
