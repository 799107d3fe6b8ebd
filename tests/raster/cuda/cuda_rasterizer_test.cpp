// SPDX-License-Identifier: BSD-3-Clause
// The device's rasterizer draws the serial reference's bits, through the façade's --device cuda.
// This program has the device code on the CPU (CMakeLists.txt).
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <bench/cuda/device.hpp>

#include <rastrum/error.hpp>
#include <rastrum/family.hpp>
#include <rastrum/program.hpp>
#include <rastrum/render.hpp>

#include "tests/support/device_frames.hpp"
#include "tests/support/passes.hpp"
#include "tests/support/random.hpp"
#include "tests/support/refused.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/test_share.hpp"

namespace rastrum::test::cuda_rasterizer_test {
namespace {

struct Variant {
  int width, height;
  Shader shader;
  Cull cull;
};
class CudaFamily : public CudaTest, public testing::WithParamInterface<Variant> {};
using CudaRasterizer = CudaTest;

TEST_P(CudaFamily, EqualsSerial) {
  const Variant v = GetParam();
  RenderOptions on_serial = device_options(v.width, v.height, Device::serial);
  on_serial.shader = v.shader;
  on_serial.cull = v.cull;
  Painter serial(on_serial), cuda(by(on_serial, Device::cuda));
  const int scenes = share_of(200, kSceneKinds);
  for (int i = 0; i < scenes; ++i) {
    const auto seed = static_cast<std::uint64_t>(i + v.width * 1000000);
    const GeneratedScene g = generate(seed, v.width, v.height);
    const Frame expected = draw(serial, g.view(), g.camera);
    const Frame frame = draw(cuda, g.view(), g.camera);
    ASSERT_TRUE(same_frame(frame, expected)) << "scene " << seed << " (" << g.kind << ")";
    ASSERT_TRUE(counts_add_up(frame));
    ASSERT_EQ(frame.stats.device, Device::cuda);
    const bool by_host = v.shader == Shader::wireframe;
    ASSERT_TRUE(holds(frame.stats.why, by_host ? "shaded by the host" : "shaded on the device"));
  }
}
INSTANTIATE_TEST_SUITE_P(Variants, CudaFamily,
                         testing::Values(Variant{64, 64, Shader::phong, Cull::none},
                                         Variant{37, 53, Shader::flat, Cull::none},
                                         Variant{128, 96, Shader::normal, Cull::back},
                                         Variant{1, 1, Shader::id, Cull::none},
                                         Variant{8, 8, Shader::depth, Cull::front},
                                         Variant{100, 20, Shader::wireframe, Cull::none},
                                         Variant{17, 128, Shader::lambert, Cull::none},
                                         Variant{65, 33, Shader::material, Cull::none}));

/// A soup from less than a pixel to the whole picture.
Scene soup(int triangles, int width, int height) {
  Random random(7);
  Mesh mesh;
  for (int t = 0; t < triangles; ++t) {
    const double size = t % 300 == 0 ? 600 : t % 7 == 0 ? 60 : random.real(0.3, 12);
    const double x = random.real(0, width), y = random.real(0, height);
    for (int c = 0; c < 3; ++c)
      mesh.positions.push_back(at_pixel(x + random.real(-size, size), y + random.real(-size, size),
                                        random.real(0.1, 0.9), width, height));
  }
  return single(std::move(mesh));
}

// Each of the three size classes can draw everything, and neither they nor bands and batches change
// a bit.
TEST_F(CudaRasterizer, SizesAndCutsChangeNothing) {
  constexpr int kWidth = 300, kHeight = 500, kTriangles = 30000;
  const Viewed seen(soup(kTriangles, kWidth, kHeight), pixel_camera(kWidth, kHeight));
  Painter serial(device_options(kWidth, kHeight, Device::serial));
  const Frame expected = draw(serial, seen);
  struct Cut {
    int small_px, large_px;
    std::uint64_t limit;
  };
  std::vector<FrameStats> stats;
  for (const Cut cut : {Cut{0, 0, 0}, Cut{1, 1 << 30, 0}, Cut{1, 2, 0}, Cut{4000, 0, 0},
                        Cut{0, 0, 3000000}, Cut{1, 500, 3000000}}) {
    RenderOptions o = device_options(kWidth, kHeight, Device::cuda);
    o.tuning.small_px = cut.small_px;
    o.tuning.large_px = cut.large_px;
    o.memory_limit = cut.limit;
    Painter cuda(o);
    const Frame frame = draw(cuda, seen);
    ASSERT_TRUE(same_frame(frame, expected))
        << cut.small_px << ' ' << cut.large_px << ' ' << cut.limit;
    // The limit does not count the mesh or its copy.
    if (cut.limit > 0) {
      EXPECT_LE(frame.stats.peak_bytes, cut.limit + std::uint64_t{kTriangles} * 3 * sizeof(Vec3));
    }
    stats.push_back(frame.stats);
  }
  EXPECT_GT(counter(stats[0], "larger pieces"), 500U);
  EXPECT_LT(counter(stats[0], "larger pieces"), kTriangles / 2);
  EXPECT_GT(counter(stats[0], "tile pairs"), 1000U);
  EXPECT_EQ(counter(stats[1], "tile pairs"), 0U);
  EXPECT_GT(counter(stats[2], "larger pieces"), kTriangles / 2);
  EXPECT_GT(counter(stats[2], "tile pairs"), counter(stats[2], "larger pieces"));
  EXPECT_LT(counter(stats[3], "larger pieces"), counter(stats[0], "larger pieces"));
  EXPECT_EQ(counter(stats[0], "bands"), 1U);
  EXPECT_EQ(counter(stats[0], "batches"), 1U);
  EXPECT_GT(counter(stats[4], "bands"), 1U);
  EXPECT_GT(counter(stats[4], "batches"), counter(stats[4], "bands"));
}

TEST_F(CudaRasterizer, RefusesALimitThatHoldsNoBand) {
  RenderOptions o = device_options(4000, 100, Device::cuda);
  o.memory_limit = 1 << 20;
  Painter cuda(o);
  const Viewed seen(soup(10, 64, 64), pixel_camera(64, 64));
  expect_refused("memory limit of 1048576 bytes", Errc::out_of_memory,
                 [&] { (void)draw(cuda, seen); });
}

TEST_F(CudaRasterizer, FramesAfterTheFirstHoldNoMore) {
  Painter cuda(device_options(200, 150, Device::cuda));
  const Viewed seen(soup(5000, 200, 150), pixel_camera(200, 150));
  const std::uint64_t first = draw(cuda, seen).stats.peak_bytes;
  EXPECT_GT(first, 200U * 150 * 8);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(draw(cuda, seen).stats.peak_bytes, first);
}

TEST_F(CudaRasterizer, NamesAnIndexOutOfRange) {
  Painter cuda(device_options(64, 64, Device::cuda));
  Scene scene = soup(2, 64, 64);
  scene.meshes[0].indices = {0, 1, 2, 3, 4, 6};
  expect_refused("index 6 is out of range",
                 [&] { (void)draw(cuda, SceneBinding(scene).view(), pixel_camera(64, 64)); });
}

TEST_F(CudaRasterizer, SaysWhatItLeavesToTheCpu) {
  RenderOptions o = device_options(64, 64, Device::cuda);
  o.opacity = 0.5F;
  Painter cuda(o), serial(by(o, Device::serial));
  const Viewed seen(soup(200, 64, 64), pixel_camera(64, 64));
  const Frame frame = draw(cuda, seen);
  EXPECT_TRUE(same_picture(frame, draw(serial, seen), 0));
  EXPECT_EQ(frame.stats.device, Device::threads);
  EXPECT_TRUE(holds(frame.stats.device_why, "translucent"));
}

TEST_F(CudaRasterizer, IsTakenByAutoUnlessTheCpusIsAskedFor) {
  RenderOptions o = device_options(64, 64, Device::automatic);
  EXPECT_EQ(Painter(o).options().device, Device::cuda);
  o.rasterizer = "tiled";
  EXPECT_EQ(Painter(o).options().device, Device::threads);
  o.device = Device::cuda;
  EXPECT_EQ(Painter(o).options().device, Device::cuda);
  o.rasterizer = "by-colour";
  EXPECT_THROW(Painter{o}, Error);
  o.rasterizer = "by-size";
  EXPECT_EQ(Painter(o).options().device, Device::cuda);
}

TEST_F(CudaRasterizer, AutoLeavesToTheThreadsWhatTheyDrawSooner) {
  RenderOptions o = device_options(64, 64, Device::automatic);
  o.threads = 1;
  const Viewed few(soup(200, 64, 64), pixel_camera(64, 64)),
      many(soup(100000, 64, 64), pixel_camera(64, 64));
  Painter renderer(o);
  const Frame on_threads = draw(renderer, few), on_device = draw(renderer, many);
  EXPECT_EQ(on_threads.stats.device, Device::threads);
  EXPECT_TRUE(holds(on_threads.stats.device_why, ", but 200 primitives at 64x64 are expected"));
  EXPECT_EQ(on_device.stats.device, Device::cuda);
  EXPECT_TRUE(holds(on_device.stats.device_why, "; 100000 primitives at 64x64 are expected"));
  Painter asked(by(o, Device::cuda));
  const Frame frame = draw(asked, few);
  EXPECT_EQ(frame.stats.device, Device::cuda);
  EXPECT_EQ(frame.stats.device_why, "");
  EXPECT_TRUE(same_frame(frame, on_threads));
}

/// A mesh and a picture in the device's memory.
struct OnDevice {
  bench::DeviceArray<Vec3> positions;
  bench::DeviceArray<std::uint32_t> indices;
  bench::DeviceArray<Vec4> colors;
  bench::DeviceArray<std::uint32_t> color_indices;
  MeshView there;
  InstanceView instance{there};
  bench::DeviceMemory color8, color, depth, ids;
  Targets targets;
  int width, height;

  OnDevice(const Mesh& mesh, int w, int h)
      : positions(std::span(mesh.positions)),
        indices(std::span(mesh.indices)),
        colors(std::span(mesh.colors.values)),
        color_indices(std::span(mesh.colors.indices)),
        color8(bytes<Rgba8>(w, h)),
        color(bytes<Vec4>(w, h)),
        depth(bytes<float>(w, h)),
        ids(bytes<std::int64_t>(w, h)),
        width(w),
        height(h) {
    there = {.positions = positions.view(),
             .indices = indices.view(),
             .colors = {colors.view(), color_indices.view()}};
    targets.color8 = view<Rgba8>(color8);
    targets.color = view<Vec4>(color);
    targets.depth = view<float>(depth);
    targets.ids = view<std::int64_t>(ids);
  }
  [[nodiscard]] SceneView scene() const { return {.instances = {&instance, 1}}; }
  /// Copies the targets into a frame's images of the same size.
  void read(Frame& to) const {
    color8.read(to.color8.pixels().data(), to.color8.pixels().size_bytes());
    color.read(to.color.pixels().data(), to.color.pixels().size_bytes());
    depth.read(to.depth.pixels().data(), to.depth.pixels().size_bytes());
    ids.read(to.ids.pixels().data(), to.ids.pixels().size_bytes());
  }

 private:
  template <class T>
  static std::size_t bytes(int w, int h) {
    return static_cast<std::size_t>(w) * static_cast<std::size_t>(h) * sizeof(T);
  }
  template <class T>
  [[nodiscard]] ImageView<T> view(const bench::DeviceMemory& memory) const {
    return {static_cast<T*>(memory.data()), width, height, width};
  }
};

class InPlace : public CudaTest {
 protected:
  static constexpr int kWidth = 200, kHeight = 150, kTriangles = 20000;
  Scene scene = soup(kTriangles, kWidth, kHeight);
  Mesh& mesh = scene.meshes[0];
  const Camera camera = pixel_camera(kWidth, kHeight);
  RenderOptions options = device_options(kWidth, kHeight, Device::serial);

  InPlace() {
    Random random(3);
    for (std::uint32_t i = 0; i < mesh.positions.size(); ++i) {
      mesh.indices.push_back(i);
      mesh.colors.values.push_back({static_cast<float>(random.real(0, 1)), 0.5F, 0.25F, 1});
      mesh.colors.indices.push_back(i / 2);
    }
  }
  [[nodiscard]] Frame on_serial() {
    Painter serial(by(options, Device::serial));
    return draw(serial, SceneBinding(scene).view(), camera);
  }
  [[nodiscard]] static RenderOptions in_place(RenderOptions o) {
    o.in_place = true;
    return by(std::move(o), Device::cuda);
  }
  /// Expects one wait, no Thrust algorithm and no allocation. A launch costs some microseconds and
  /// a wait about twenty, so any addition must change these numbers and give a reason.
  static void expect_work(const FrameStats& stats, std::uint64_t launches, std::uint64_t copies) {
    EXPECT_EQ(counter(stats, "launches"), launches);
    EXPECT_EQ(counter(stats, "device algorithms"), 0U);
    EXPECT_EQ(counter(stats, "device waits"), 1U);
    EXPECT_EQ(counter(stats, "device copies"), copies);
    EXPECT_EQ(counter(stats, "blocks allocated"), 0U);
  }
};

TEST_F(InPlace, NothingIsCopied) {
  Frame expected = on_serial();
  Frame frame = expected;
  options.device = Device::cuda;
  Painter copying(options);
  const std::uint64_t copied = copying
                                   .render(SceneBinding(scene).view(), camera,
                                           {.color8 = frame.color8,
                                            .color = frame.color,
                                            .depth = frame.depth,
                                            .ids = frame.ids})
                                   .peak_bytes;
  OnDevice there(mesh, kWidth, kHeight);
  Painter in_place(InPlace::in_place(options));
  const FrameStats stats = in_place.render(there.scene(), camera, there.targets);
  const Scene other = soup(1, 8, 8);
  frame = draw(copying, SceneBinding(other).view(), camera);
  there.read(frame);
  frame.overdraw = expected.overdraw;
  EXPECT_TRUE(same_surfaces(frame, expected));
  EXPECT_TRUE(same_picture(frame, expected, 0));
  EXPECT_EQ(stats.fragments, expected.stats.fragments);
  // An arena's blocks can be a quarter larger than what was asked for.
  const std::uint64_t arrays = mesh.positions.size() * (sizeof(Vec3) + sizeof(Vec4) + 2 * 4) +
                               std::uint64_t{kWidth} * kHeight * (4 + 16 + 4 + 8);
  EXPECT_GE(copied, stats.peak_bytes + arrays);
}

TEST_F(InPlace, BadIndicesAndTargetsAreRefused) {
  const auto refuses = [&](const OnDevice& there, const Targets& wanted, const char* what,
                           Errc code = Errc::invalid_argument) {
    Painter in_place(InPlace::in_place(options));
    expect_refused(what, code, [&] { (void)in_place.render(there.scene(), camera, wanted); });
  };
  const OnDevice good(mesh, kWidth, kHeight);
  Image<std::uint32_t> overdraw(kWidth, kHeight);
  Targets with_overdraw = good.targets;
  with_overdraw.overdraw = overdraw.view();
  refuses(good, with_overdraw, "only the targets color8", Errc::unsupported);
  mesh.colors.indices.back() = static_cast<std::uint32_t>(mesh.positions.size());
  const OnDevice bad_color(mesh, kWidth, kHeight);
  refuses(bad_color, bad_color.targets, "colors have an index out of range");
  mesh.colors.indices.back() = 0;
  mesh.indices.back() = static_cast<std::uint32_t>(mesh.positions.size());
  const OnDevice bad_index(mesh, kWidth, kHeight);
  refuses(bad_index, bad_index.targets, "1 primitives have an index");
}

// A frame waits for the caller's stream if it has one.
TEST_F(InPlace, WhatWritesTheArraysComesFirst) {
  const Frame expected = on_serial();
  // The mesh starts elsewhere; work in a stream moves it.
  const std::vector<Vec3> positions = mesh.positions;
  for (Vec3& p : mesh.positions) p = {0, 0, -1e6F};
  const OnDevice there(mesh, kWidth, kHeight);
  bench::StreamOfACaller stream;
  Frame frame = expected;
  Renderer renderer = family::make_renderer(InPlace::in_place(options), options);
  stream.write(there.positions, std::span(positions));
  const FrameStats stats = renderer.render_in_place(there.scene(), camera, options, there.targets,
                                                    {}, DeviceStream{stream.handle()});
  there.read(frame);
  EXPECT_TRUE(same_surfaces(frame, expected));
  EXPECT_EQ(stats.fragments, expected.stats.fragments);
}

// The second frame of its kind, with arrays and targets on the device.
TEST_F(InPlace, LaunchesAndWaitsOfAFrame) {
  mesh.colors = {};  // their indices need a check, which is a sum on the device
  const OnDevice there(mesh, kWidth, kHeight);
  Painter in_place(InPlace::in_place(options));
  (void)in_place.render(there.scene(), camera, there.targets);
  const FrameStats stats = in_place.render(there.scene(), camera, there.targets);
  // Vertices, three to clear, four to draw, one to resolve.
  expect_work(stats, 9, 6);
}

// The same for translucent triangles, in the third frame, because the first one guesses the number
// of records.
TEST_F(InPlace, LaunchesAndWaitsOfALayeredFrame) {
  mesh.colors = {};
  mesh.indices.resize(1500);
  const OnDevice there(mesh, kWidth, kHeight);
  for (const Transparency method : {Transparency::exact, Transparency::unsorted}) {
    options.opacity = 0.5F;
    options.transparency.method = method;
    Frame frame = on_serial();
    const Frame expected = frame;
    Painter in_place(InPlace::in_place(options));
    for (int i = 0; i < 2; ++i) (void)in_place.render(there.scene(), camera, there.targets);
    const FrameStats stats = in_place.render(there.scene(), camera, there.targets);
    there.read(frame);
    EXPECT_TRUE(same_surfaces(frame, expected));
    EXPECT_TRUE(same_picture(frame, expected, 0));
    EXPECT_GT(counter(stats, "translucent fragments"), 10000U);
    EXPECT_EQ(counter(stats, "bands listed"), 0U);
    // Nine as for opaque frames, one for the colours of the surface, eight for layers.
    expect_work(stats, 18, 6);
  }
}

// The same for triangles over an existing picture, which test each fragment. The arrays are the
// host's, copied by the first frame; the picture is copied to the device and back.
TEST_F(InPlace, LaunchesAndWaitsOfATestedFrame) {
  mesh.colors = {};
  const SceneBinding binding(scene);
  Frame frame = on_serial();
  options.device = Device::cuda;
  Painter cuda(options);
  const Targets targets{.color8 = frame.color8, .depth = frame.depth};
  (void)cuda.render(binding.view(), camera, targets, {.over = true});
  const FrameStats stats = cuda.render(binding.view(), camera, targets, {.over = true});
  // Nine as for opaque frames, and two for tested pieces.
  expect_work(stats, 11, 10);
}

// A caller's arrays stay on the device while they do not change. Every change shows, even of one
// bit, in place or elsewhere.
TEST_F(InPlace, AMeshIsCopiedWhenItIsNewOrWasChanged) {
  options.device = Device::cuda;
  Painter cuda(options);
  const auto copied = [&](const char* what) {
    const Frame expected = on_serial();
    const Frame frame = draw(cuda, SceneBinding(scene).view(), camera);
    EXPECT_TRUE(same_surfaces(frame, expected)) << what;
    EXPECT_TRUE(same_picture(frame, expected, 0)) << what;
    return counter(frame.stats, "arrays copied");
  };
  EXPECT_EQ(copied("new"), 4U);  // positions, colours, and the indices of both
  EXPECT_EQ(copied("the same"), 0U);
  Random random(17);
  for (int i = 0; i < 2; ++i) {
    const auto at =
        static_cast<std::size_t>(random.integer(0, static_cast<int>(mesh.positions.size()) - 1));
    Vec3& p = mesh.positions[at];
    const float before = p.x;
    p.x += 3;
    EXPECT_EQ(copied("moved"), 1U);
    p.x = std::nextafter(before, 1e9F);
    EXPECT_EQ(copied("by a bit"), 1U);
  }
  std::swap(mesh.positions.front(), mesh.positions.back());
  EXPECT_EQ(copied("two exchanged"), 1U);
  mesh.colors.values[5].y = 0.75F;
  mesh.indices[7] = mesh.indices[8];
  EXPECT_EQ(copied("colour and index"), 2U);
  mesh.positions = std::vector<Vec3>(mesh.positions);
  EXPECT_LE(copied("elsewhere"), 1U);
  mesh.positions.resize(mesh.positions.size() + 3, {0, 0, 0.5F});
  EXPECT_EQ(copied("longer"), 1U);
  // Arrays that a frame does not read are dropped, and arrays that a failed frame did not copy are
  // copied by the next.
  const Scene other = soup(10, kWidth, kHeight);
  (void)draw(cuda, SceneBinding(other).view(), camera);
  (void)draw(cuda, SceneBinding(other).view(), camera);
  EXPECT_EQ(copied("after another"), 4U);
  mesh.indices[9] = 1U << 30;
  EXPECT_THROW((void)draw(cuda, SceneBinding(scene).view(), camera), Error);
  mesh.indices[9] = 9;
  EXPECT_EQ(copied("after a failure"), 4U);
}

/// Points, lines and triangles of one vertex function, some behind the eye, beyond the guard band
/// or not finite; with widths, biases and windings.
struct Mix {
  std::vector<Vec4> clip;
  std::vector<std::vector<std::uint32_t>> indices;
  std::vector<raster::Draw> draws;

  template <class Program>
  void make_draws(Random& r, const Program& program) {
    constexpr Topology kTopologies[] = {Topology::points, Topology::lines, Topology::triangles};
    for (int d = 0; d < 6; ++d) {
      const Topology topology = kTopologies[d % 3];
      auto& list = indices.emplace_back();
      for (int i = 30 * static_cast<int>(topology); i > 0; --i)
        list.push_back(static_cast<std::uint32_t>(r.integer(0, static_cast<int>(clip.size()) - 1)));
      raster::Draw& draw = draws.emplace_back(program.draw(clip.size(), list, topology));
      draw.line_width = static_cast<float>(r.real(0.1, 9));
      draw.point_size = static_cast<float>(r.real(0.1, 30));
      if (r.chance(0.5)) draw.depth_bias = static_cast<float>(r.real(-0.3, 0.3));
      if (r.chance(0.5)) draw.depth_bias_slope = static_cast<float>(r.integer(-2, 2));
      draw.cull = static_cast<Cull>(r.integer(0, 2));
      draw.winding = static_cast<Winding>(r.integer(0, 2));
    }
  }
  Mix(Random& r, int width, int height) {
    indices.reserve(8);
    for (int i = 0; i < 60; ++i) {
      const double w = r.real(0.1, 4);
      Vec4 v{static_cast<float>((2 * r.real(-8, width + 8) / width - 1) * w),
             static_cast<float>((1 - 2 * r.real(-8, height + 8) / height) * w),
             static_cast<float>(r.integer(0, 8) / 8.0 * w), static_cast<float>(w)};
      if (r.chance(0.05)) v.w = -v.w;
      if (r.chance(0.05)) v.z = v.w + 0.5F;
      if (r.chance(0.05)) v.x *= 1e5F;
      if (r.chance(0.02)) v.y = std::numeric_limits<float>::quiet_NaN();
      clip.push_back(v);
    }
  }
};

TEST_F(CudaRasterizer, DrawsOfAllTopologiesEqualSerial) {
  constexpr int kWidth = 130, kHeight = 91;
  Painter serial(device_options(kWidth, kHeight, Device::serial));
  Painter cuda(device_options(kWidth, kHeight, Device::cuda));
  FrameStats::Triangles seen;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    Random random(seed);
    Mix mix(random, kWidth, kHeight);
    const Program program(
        [&mix](std::uint32_t v) {
          return VertexOutput<Vec4>{mix.clip[v], mix.clip[v]};
        },
        [](const Vec4& v, const Fragment& f) {
          return Vec4{v.x, f.depth, static_cast<float>(f.vertex[0]), 1};
        });
    mix.make_draws(random, program);
    const Frame expected = draw(serial, mix.draws, program, nullptr);
    const Frame frame = draw(cuda, mix.draws, program, nullptr);
    ASSERT_TRUE(same_frame(frame, expected)) << seed;
    seen.clipped += frame.stats.triangles.clipped;
    seen.dropped += frame.stats.triangles.dropped;
  }
  EXPECT_GT(seen.clipped, 100U);
  EXPECT_GT(seen.dropped, 100U);
}

// Points and lines are equal at all samples, triangles are not. Without colours, since the shader
// is the host's.
TEST_F(CudaRasterizer, SamplesOfAllTopologiesEqualSerial) {
  constexpr int kWidth = 83, kHeight = 61;
  RenderOptions o = device_options(kWidth, kHeight, Device::serial);
  o.samples = 4;
  Painter serial(o), cuda(by(o, Device::cuda));
  for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(share_of(20, 4)); ++seed) {
    Random random(seed);
    Mix mix(random, kWidth, kHeight);
    const Program program(
        [&mix](std::uint32_t v) {
          return VertexOutput<Vec4>{mix.clip[v], mix.clip[v]};
        },
        [](const Vec4& v, const Fragment&) { return v; });
    mix.make_draws(random, program);
    const auto take = [&](Painter& renderer) {
      Frame f(kWidth, kHeight, kVisible | kOverdraw);
      std::vector<raster::Draw> draws = mix.draws;
      f.stats = renderer.draw(draws, program, nullptr, f.targets());
      return f;
    };
    const Frame expected = take(serial), frame = take(cuda);
    ASSERT_EQ(frame.stats.device, Device::cuda) << frame.stats.device_why;
    ASSERT_TRUE(same_frame(frame, expected)) << seed;
  }
}

TEST_F(CudaRasterizer, PassesEqualOneDraw) {
  for (const std::uint64_t limit : {std::uint64_t{0}, std::uint64_t{3} << 20}) {
    RenderOptions o = device_options(150, 200, Device::cuda);
    o.memory_limit = limit;
    Painter cuda(o);
    for (const char* shape : {"soup?count=3000", "boxes"})
      EXPECT_TRUE(passes_equal_one_draw(cuda, shape)) << limit;
  }
}

}  // namespace
}  // namespace rastrum::test::cuda_rasterizer_test
