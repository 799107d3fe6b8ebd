// SPDX-License-Identifier: BSD-3-Clause
// Frames copy no array: the memory of a frame does not grow with a mesh beyond that of the packed
// layout, for any layout. And whichever allocation fails, no std::bad_alloc leaves the library.
// This is a program of its own because it counts allocations of `new`.
#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <new>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/annotate.hpp>
#include <rastrum/error.hpp>
#include <rastrum/program.hpp>
#include <rastrum/render.hpp>
#include <rastrum/shapes.hpp>
#include <rastrum/terrain.hpp>

#include "tests/support/array_layouts.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/surface_layouts.hpp"
#include "tests/support/test_share.hpp"

namespace {

std::atomic<std::uint64_t> asked_for{0};
std::atomic<std::int64_t> left_until_failure{-1};  ///< below 0: none fails

void* counted(std::size_t bytes, std::size_t alignment) {
  asked_for.fetch_add(bytes, std::memory_order_relaxed);
  if (left_until_failure >= 0 && left_until_failure.fetch_sub(1) == 0) throw std::bad_alloc();
  const std::size_t whole = (bytes + alignment - 1) / alignment * alignment;
  if (void* const p = std::aligned_alloc(alignment, whole == 0 ? alignment : whole)) return p;
  throw std::bad_alloc();
}

// Not inline, because GCC warns if it sees free() of memory from `new`.
[[gnu::noinline]] void release(void* p) noexcept {
  std::free(p);
}

}  // namespace

void* operator new(std::size_t n) {
  return counted(n, alignof(std::max_align_t));
}
void* operator new(std::size_t n, std::align_val_t a) {
  return counted(n, static_cast<std::size_t>(a));
}
// The sanitizer's version would not match the delete below.
void* operator new(std::size_t n, const std::nothrow_t&) noexcept {
  try {
    return counted(n, alignof(std::max_align_t));
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}
void operator delete(void* p) noexcept {
  release(p);
}
void operator delete(void* p, std::size_t) noexcept {
  release(p);
}
void operator delete(void* p, std::align_val_t) noexcept {
  release(p);
}
void operator delete(void* p, std::size_t, std::align_val_t) noexcept {
  release(p);
}

namespace rastrum::test::allocations_test {
namespace {

constexpr std::uint64_t kSmall = 16 << 10;

/// The memory of a mesh's frame: from `new`, and scratch, which has an account of its own.
struct Bytes {
  std::uint64_t asked, scratch;
};

Bytes bytes_of(const GeometryView& geometry, FrameOptions look, std::uint64_t limit = 0) {
  look.width = 160;
  look.height = 120;
  const InstanceView instance{geometry};
  std::vector<Material> materials(2);
  Image<Rgba8> image(look.width, look.height);
  Camera camera{.eye = {0.3, -0.8, 1.9}};
  // One thread, so that the threads' memory is the same in each run.
  Renderer renderer({.memory_limit = limit, .threads = 1});
  const std::uint64_t before = asked_for;
  const FrameStats stats = renderer.render({.instances = {&instance, 1}, .materials = materials},
                                           camera, look, {.color8 = image});
  return {asked_for - before, stats.peak_bytes};
}

TEST(Allocations, OfALayoutAreThoseOfThePackedMesh) {
  const Sheet sheet(220);  // 96,800 triangles: a copy of any of its arrays is 190 KB or more
  for (const FrameOptions& look :
       {FrameOptions{.shader = Shader::phong}, FrameOptions{.shader = Shader::material},
        FrameOptions{.shader = Shader::flat, .opacity = 0.5F}})
    for (const std::uint64_t limit : {std::uint64_t{0}, std::uint64_t{4} << 20}) {
      const Bytes packed = bytes_of(sheet.view(), look, limit);
      EXPECT_GT(packed.scratch, kSmall);
      for (const Layout& layout : layouts()) {
        if (layout.name.ends_with("int16")) continue;  // int16 has too few vertices
        Memory memory;
        const Bytes other = bytes_of(layout.view(sheet, memory), look, limit);
        EXPECT_LE(other.asked, packed.asked + kSmall) << layout.name;
        EXPECT_LE(other.scratch, packed.scratch + kSmall) << layout.name;
      }
      // float64 too, whose picture may differ.
      std::vector<Vec3d> wide(sheet.positions.begin(), sheet.positions.end());
      MeshView mesh = sheet.view();
      mesh.positions = wide;
      const Bytes other = bytes_of(mesh, look, limit);
      EXPECT_LE(other.asked, packed.asked + kSmall);
      EXPECT_LE(other.scratch, packed.scratch + packed.scratch / 50);
    }
}

TEST(Allocations, OfSpheresAndTheirKinAreThoseOfThePackedOnes) {
  Cloud cloud(30000);  // a copy of any of its arrays is 120 KB or more
  // Small ones on one thread, so that pixels do not take the time.
  for (std::uint32_t i = 0; i < cloud.positions.size(); ++i) {
    cloud.radii[i] /= 64;
    cloud.pairs[i] = i ^ 1U;
    if (i > 0) cloud.positions[i] = cloud.positions[i - 1] + cloud.normals[i] * 0.02F;
  }
  for (const FrameOptions& look : {FrameOptions{.shader = Shader::phong},
                                   FrameOptions{.shader = Shader::flat, .opacity = 0.5F}}) {
    std::vector<Bytes> packed;
    for (const GeometryView& g : CloudViews(cloud).geometries())
      packed.push_back(bytes_of(g, look));
    for (const CloudLayout& layout : cloud_layouts()) {
      // Small integers allow only fewer places.
      if (layout.name.find("int8") != std::string::npos ||
          layout.name.find("int16") != std::string::npos)
        continue;
      Memory memory;
      const std::vector<GeometryView> other = layout.geometries(cloud, memory);
      for (std::size_t i = 0; i < other.size(); ++i) {
        const Bytes b = bytes_of(other[i], look);
        EXPECT_GT(packed[i].scratch, 4 * kSmall) << "geometry " << i;
        EXPECT_LE(b.asked, packed[i].asked + kSmall) << layout.name << ", geometry " << i;
        EXPECT_LE(b.scratch, packed[i].scratch + kSmall) << layout.name << ", geometry " << i;
      }
    }
  }
}

/// Calls f() until it makes no failing allocation; each time a later one fails: each of the first
/// ones, and ever fewer of those behind them. `./dev check --full` leaves out none.
template <class F>
void expect_no_bad_alloc(const char* what, const F& f) {
  SCOPED_TRACE(what);
  const std::int64_t first_ones = is_full() ? INT64_MAX : test_share() < 100 ? 4 : 40;
  std::int64_t failed = 0;
  for (bool fails = true; fails; failed += 1 + failed / first_ones) {
    left_until_failure = failed;
    try {
      f();
    } catch (const Error& e) {
      EXPECT_EQ(e.code(), Errc::out_of_memory) << failed << ": " << e.what();
    } catch (const std::exception& e) {
      ADD_FAILURE() << "allocation " << failed << ": " << e.what();
    }
    fails = left_until_failure.exchange(-1) < 0;
  }
  EXPECT_GT(failed, 1) << "no allocation has failed";
}

TEST(Allocations, ThatFailAreAnErrorOfTheLibrary) {
  const Mesh knot = shapes::torus_knot(2, 3, 64, 12);
  const OneInstance instance(knot.view());
  const Material material{.roughness = 0.5F};
  const SceneView plain = instance.view();
  SceneView shiny = plain;
  shiny.materials = {&material, 1};
  const Camera camera = fit_camera(plain, 1, false);
  FrameOptions frame{.width = 96, .height = 72};
  Image<Rgba8> image(frame.width, frame.height), expected(frame.width, frame.height);
  const auto draw = [&](Renderer& renderer, const SceneView& scene, const FrameOptions& look) {
    return [&, look] { renderer.render(scene, camera, look, {.color8 = image}); };
  };
  const Program program(
      [&](std::uint32_t i) {
        return VertexOutput<Vec3>{{i == 1 ? 3.0F : -1.0F, i == 2 ? 3.0F : -1.0F, 0.5F, 1}, {}};
      },
      [](const Vec3&, const Fragment&) {
        return Vec4{1, 1, 1, 1};
      });
  const ProgramDraw whole = program.draw(3);
  terrain::HeightMap map;
  map.heights = Image<float>(64, 64);
  const terrain::Terrain ground(map);
  const Annotations notes{.occlusion = AmbientOcclusion{},
                          .silhouettes = Silhouettes{},
                          .edges = EdgeLines{},
                          .bounds = true,
                          .title = "knot"};
  for (const Device device : {Device::serial, Device::threads}) {
    const RendererOptions options{.device = device, .threads = 2};
    expect_no_bad_alloc("a renderer's first frame", [&] {
      Renderer renderer(options);
      renderer.render(plain, camera, frame, {.color8 = image});
    });
    Renderer renderer(options);
    renderer.render(plain, camera, frame, {.color8 = expected});
    frame.opacity = 0.5F;
    expect_no_bad_alloc("layers", draw(renderer, plain, frame));
    frame.samples = 4;
    expect_no_bad_alloc("layers of samples", draw(renderer, shiny, frame));
    frame.opacity = 1;
    expect_no_bad_alloc("samples", draw(renderer, plain, frame));
    frame.samples = 1;
    frame.shadows = true;
    frame.lights = {Light{.kind = DirectionalLight{.direction = {0, -1, -1}}}};
    expect_no_bad_alloc("shadows", draw(renderer, shiny, frame));
    frame.shadows = false;
    frame.lights.clear();
    expect_no_bad_alloc("a pick", [&] { (void)renderer.pick(plain, camera, frame, 48, 36); });
    expect_no_bad_alloc("a program", [&] { renderer.draw({&whole, 1}, frame, {.color8 = image}); });
    expect_no_bad_alloc("annotations", [&] {
      Annotator(2).render(renderer, plain, camera, frame, notes, {.color8 = image});
    });
    expect_no_bad_alloc("a terrain", [&] {
      terrain::TerrainRenderer({.device = device, .threads = 2})
          .render(ground, {}, {.width = 96, .height = 72}, {.color8 = image});
    });
    renderer.render(plain, camera, frame, {.color8 = image});
    EXPECT_TRUE(std::ranges::equal(image.pixels(), expected.pixels())) << "it remains usable";
  }
}

}  // namespace
}  // namespace rastrum::test::allocations_test
