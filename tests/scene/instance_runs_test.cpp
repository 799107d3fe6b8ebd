// SPDX-License-Identifier: BSD-3-Clause
// Equal instances are drawn as one run (scene/instance_runs.hpp). A twin scene, whose instances
// view their own arrays with the same numbers, has no runs. Its pictures, outputs, counts, picks
// and refusals must be equal, bit for bit.
#include <cmath>
#include <cstdint>
#include <cstring>
#include <list>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/error.hpp>
#include <rastrum/parallel/exec.hpp>
#include <rastrum/pick.hpp>
#include <rastrum/render.hpp>
#include <rastrum/scene/instance_runs.hpp>

#include "tests/support/array_layouts.hpp"
#include "tests/support/random.hpp"
#include "tests/support/refused.hpp"

#include "tests/support/test_share.hpp"

namespace rastrum::test::instance_runs_test {
namespace {

constexpr int kW = 150, kH = 110;

/// The arrays of a mesh, and ways to view them.
struct Arrays {
  Sheet sheet;
  std::vector<Vec3d> wide;
  std::vector<Vec3> soup;
  std::vector<Vec4> soup_colors;
  std::vector<std::uint32_t> mirrored;  ///< a normal's index for each corner

  explicit Arrays(int n) : sheet(n), wide(sheet.positions.begin(), sheet.positions.end()) {
    for (const std::uint32_t i : sheet.indices) {
      soup.push_back(sheet.positions[i]);
      soup_colors.push_back(sheet.colors[(soup.size() * 5) % sheet.colors.size()]);
      mirrored.push_back(static_cast<std::uint32_t>(sheet.normals.size()) - 1 - i);
    }
  }
  static constexpr int kKinds = 6;
  [[nodiscard]] MeshView view(int kind) const {
    MeshView v = sheet.view();
    switch (kind) {
      case 1:  // no indices, normals of faces, colours by corner
        v = {};
        v.positions = soup;
        v.colors = {.values = soup_colors, .per = Per::corner};
        break;
      case 2:
        v.indices = sheet.quads;
        v.faces.kind = FaceKind::quads;
        v.face_materials = sheet.quad_materials;
        break;
      case 3:
        v.positions = wide;
        v.normals.indices = mirrored;
        v.face_materials = {};
        break;
      case 4:
        v.colors = {.values = std::span(sheet.colors).first(1), .per = Per::mesh};
        v.material = 1;
        v.face_materials = {};
        break;
      case 5:
        v.colors = {};
        v.normals = {};
        break;
      default:
        break;
    }
    return v;
  }
};

struct Dice : Random {
  using Random::Random;
  int below(int n) { return integer(0, n - 1); }
};

struct Scene {
  std::vector<InstanceView> instances;
  std::vector<Material> materials;
  [[nodiscard]] SceneView view() const { return {instances, materials, {}}; }
};

/// A seed's scene with runs, and its twin without.
struct Twins {
  std::list<Arrays> arrays;
  std::list<MeshView> meshes;
  std::vector<Vec3> centers{{0.1F, 0.2F, 0.3F}, {-0.4F, 0.1F, 0.2F}};
  SpheresView spheres{.centers = centers, .radius = 0.2F};
  Scene joined, apart;
  std::size_t in_runs = 0;  ///< instances that a run joins to the one before

  explicit Twins(std::uint64_t seed) {
    Dice random(seed);
    if (random.below(2) == 0) {
      joined.materials.resize(2);
      for (Material& m : joined.materials) m.double_sided = random.below(2) == 0;
      joined.materials[0].base_color = {0.4F, 0.8F, 0.6F, 1};
      joined.materials[1].alpha_mode = random.below(2) == 0 ? AlphaMode::blend : AlphaMode::opaque;
      joined.materials[1].base_color = {0.9F, 0.4F, 0.2F, 0.6F};
    }
    apart.materials = joined.materials;
    for (int run = 0; run < 5; ++run) {
      const int kind = random.below(Arrays::kKinds);
      const int size = random.below(3) == 0 ? 13 : random.integer(1, 4);
      const Arrays& shared = arrays.emplace_back(size);
      InstanceView look;
      const auto view_of = [&](const Arrays& its_arrays) -> const MeshView& {
        MeshView& mesh = meshes.emplace_back(its_arrays.view(kind));
        if (joined.materials.empty()) mesh.material = 0;
        return mesh;
      };
      look.geometry = view_of(shared);
      if (random.below(4) == 0) look.opacity = 0.6F;
      if (random.below(5) == 0) look.visible = false;
      if (random.below(3) == 0) look.winding = Winding::clockwise;
      if (random.below(3) == 0) look.material = 0;
      const bool colored = random.below(3) == 0;
      const float alpha = random.below(2) == 0 ? 0.5F : 1.0F;
      const int count = random.integer(1, size > 4 ? 6 : 90);
      for (int i = 0; i < count; ++i) {
        look.object_to_world = placed(random);
        look.id.reset();
        if (random.below(5) == 0) look.id = random.below(1000);
        if (colored) {
          const auto c = [&] { return static_cast<float>(random.real(0, 1)); };
          look.color = Vec4{c(), c(), c(), alpha};
        }
        if (i == 40) look.opacity *= 0.75F;  // another run of the same view
        joined.instances.push_back(look);
        InstanceView own = look;
        own.geometry = view_of(arrays.emplace_back(size));
        apart.instances.push_back(own);
        in_runs += i > 0 && i != 40;
      }
      if (random.below(3) != 0) continue;
      for (Scene* s : {&joined, &apart}) s->instances.push_back({.geometry = spheres});
    }
  }

  /// Mostly small; some large, behind the eye, mirrored or flat.
  static Mat4d placed(Dice& random) {
    Mat4d m = Mat4d::identity();
    const double size = random.below(9) == 0 ? 1.5 : random.real(0.05, 0.4);
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) m.m[i][j] = random.real(-0.4, 0.4) * size + (i == j ? size : 0);
      m.m[i][3] = random.real(-1.3, 1.3);
    }
    if (random.below(6) == 0) m.m[2][3] = random.real(2, 3.5);
    if (random.below(6) == 0)
      for (double& x : m.m[0]) x = -x;
    if (random.below(20) == 0) m.m[1][1] = m.m[1][0] = m.m[1][2] = 0;
    return m;
  }
};

struct Pictures {
  Image<Vec4> color{kW, kH};
  Image<float> depth{kW, kH}, view_depth{kW, kH};
  Image<std::int64_t> ids{kW, kH}, instances{kW, kH}, primitives{kW, kH};
  Image<Vec2> barycentrics{kW, kH};
  Image<Vec3> positions{kW, kH}, normals{kW, kH}, camera_normals{kW, kH};
  FrameStats stats;
};

Camera camera() {
  return Camera{.eye = {0.3, -0.4, 2.6}};
}

Pictures draw(Renderer& renderer, const Scene& scene, FrameOptions look) {
  look.width = kW;
  look.height = kH;
  Pictures p;
  p.stats = renderer.render(scene.view(), camera(), look,
                            {.color = p.color,
                             .depth = p.depth,
                             .ids = p.ids,
                             .instances = p.instances,
                             .primitives = p.primitives,
                             .barycentrics = p.barycentrics,
                             .positions = p.positions,
                             .normals = p.normals,
                             .camera_normals = p.camera_normals,
                             .view_depth = p.view_depth});
  return p;
}

template <class T>
void expect_same(const Image<T>& a, const Image<T>& b, const char* what) {
  // Compares bytes: −0 differs from 0, and NaNs must be identical.
  EXPECT_TRUE(std::memcmp(a.pixels().data(), b.pixels().data(), a.pixels().size_bytes()) == 0)
      << what;
}

void expect_same(const Pictures& a, const Pictures& b) {
  expect_same(a.color, b.color, "color");
  expect_same(a.depth, b.depth, "depth");
  expect_same(a.view_depth, b.view_depth, "view_depth");
  expect_same(a.ids, b.ids, "ids");
  expect_same(a.instances, b.instances, "instances");
  expect_same(a.primitives, b.primitives, "primitives");
  expect_same(a.barycentrics, b.barycentrics, "barycentrics");
  expect_same(a.positions, b.positions, "positions");
  expect_same(a.normals, b.normals, "normals");
  expect_same(a.camera_normals, b.camera_normals, "camera_normals");
  const auto &s = a.stats.triangles, &t = b.stats.triangles;
  EXPECT_EQ(s.input, t.input);
  EXPECT_EQ(s.culled, t.culled);
  EXPECT_EQ(s.dropped, t.dropped);
  EXPECT_EQ(s.clipped, t.clipped);
  EXPECT_EQ(a.stats.pixels_covered, b.stats.pixels_covered);
}

const FrameOptions kLooks[] = {
    {.shader = Shader::phong},
    {.shader = Shader::flat, .cull = Cull::back},
    {.shader = Shader::id, .samples = 4},
    {.shader = Shader::lambert, .opacity = 0.7F},
    {.shader = Shader::wireframe},
    {.shader = Shader::material},
    {.shader = Shader::material, .samples = 4},
    {.shader = Shader::normal, .transparency = {.method = Transparency::none}},
    {.shader = Shader::depth},
};

TEST(InstanceRuns, DrawWhatTheirInstancesAlone) {
  const auto seeds = static_cast<std::uint64_t>(share_of(24, static_cast<int>(std::size(kLooks))));
  std::size_t in_runs = 0, covered = 0;
  Renderer renderer({.threads = 2}), serial({.device = Device::serial}),
      limited({.memory_limit = 3U << 20, .threads = 3});
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    SCOPED_TRACE(seed);
    const Twins twins(seed);
    in_runs += twins.in_runs;
    FrameOptions look = kLooks[seed % std::size(kLooks)];
    const Pictures apart = draw(renderer, twins.apart, look);
    covered += apart.stats.pixels_covered;
    expect_same(apart, draw(renderer, twins.joined, look));
    expect_same(apart, draw(serial, twins.joined, look));
    if (look.shader == Shader::phong || look.shader == Shader::flat)
      expect_same(apart, draw(limited, twins.joined, look));
  }
  EXPECT_GT(in_runs, seeds * 40);
  EXPECT_GT(covered, seeds * kW * kH / 10);
}

TEST(InstanceRuns, AreTheSameOnEveryInstructionSet) {
  Renderer scalar({.threads = 1, .isa = Isa::scalar});
  for (const Isa isa : available_isas()) {
    SCOPED_TRACE(name(isa));
    Renderer renderer({.threads = 2, .isa = isa});
    for (std::uint64_t seed = 100; seed < 106; ++seed) {
      SCOPED_TRACE(seed);
      const Twins twins(seed);
      const FrameOptions look = kLooks[seed % std::size(kLooks)];
      const Pictures joined = draw(renderer, twins.joined, look);
      expect_same(draw(renderer, twins.apart, look), joined);
      expect_same(draw(scalar, twins.joined, look), joined);
    }
  }
}

TEST(InstanceRuns, ArePickedByInstance) {
  int found = 0;
  Renderer renderer({.threads = 1});
  for (std::uint64_t seed = 200; seed < 206; ++seed) {
    const Twins twins(seed);
    for (int k = 0; k < 20; ++k) {
      const int x = (k * 37 + 11) % kW, y = (k * 53 + 7) % kH;
      const FrameOptions look{.width = kW, .height = kH};
      const auto a = renderer.pick(twins.joined.view(), camera(), look, x, y),
                 b = renderer.pick(twins.apart.view(), camera(), look, x, y);
      ASSERT_EQ(a.has_value(), b.has_value());
      if (!a) continue;
      ++found;
      EXPECT_EQ(a->instance, b->instance);
      EXPECT_EQ(a->instance_id, b->instance_id);
      EXPECT_EQ(a->primitive, b->primitive);
      EXPECT_EQ(a->position, b->position);
      EXPECT_EQ(a->normal, b->normal);
    }
  }
  EXPECT_GT(found, 20);
}

TEST(InstanceRuns, AreRefusedByTheNumberOfAnInstance) {
  const Arrays good(3);
  std::vector<std::uint32_t> beyond = good.sheet.indices;
  beyond[4] = static_cast<std::uint32_t>(good.sheet.positions.size());
  Scene scene;
  const MeshView fifth = good.view(5), first = good.view(0);
  scene.instances.assign(7, InstanceView{.geometry = fifth});
  scene.instances.resize(9, InstanceView{.geometry = first});
  Renderer renderer({.threads = 2});
  const auto refused = [&](const char* part, const Scene& bad) {
    expect_refused(part, [&] { (void)draw(renderer, bad, {.shader = Shader::phong}); });
  };
  EXPECT_NO_THROW((void)draw(renderer, scene, {.shader = Shader::phong}));

  Scene bad = scene;
  MeshView mesh = fifth;
  mesh.indices = beyond;
  bad.instances.resize(12, InstanceView{.geometry = mesh});
  refused("instance 9: indices[4]: index 16 is out of range, there are 16", bad);

  bad = scene;
  bad.instances[5].opacity = std::nanf("");
  refused("instance 5: its opacity", bad);
  bad = scene;
  for (InstanceView& i : bad.instances) i.color = Vec4{1, 1, 1, 1};
  bad.instances[3].color->y = INFINITY;
  refused("instance 3: its colour", bad);
  bad = scene;
  const std::vector<Vec3> centers(3);
  const std::vector<float> radii(2);
  const SpheresView spheres{.centers = centers, .radii = radii};
  bad.instances.push_back({.geometry = spheres});
  refused("instance 9: ", bad);
}

TEST(InstanceRuns, HoldWhatIsAlikeAndNothingElse) {
  const Arrays one(2), other(2);
  const auto lengths = [](const std::vector<InstanceView>& instances, bool joins = true) {
    const InstanceRuns runs({instances, {}, {}}, joins, nullptr);
    std::vector<std::size_t> r;
    for (std::size_t i = 0; i < runs.firsts().instances.size(); ++i) r.push_back(runs.length(i));
    return r;
  };
  using Lengths = std::vector<std::size_t>;
  // Equal views are alike; they need not be the same object.
  const MeshView mesh = one.view(0), twin = mesh, elsewhere = other.view(0), second = one.view(2);
  const SpheresView spheres{};
  std::vector<InstanceView> list(6, InstanceView{.geometry = mesh});
  EXPECT_EQ(lengths(list), Lengths{6});
  EXPECT_EQ(lengths(list, false), Lengths(6, 1));
  EXPECT_EQ(lengths({}), Lengths{});
  const auto with = [&](const auto& change) {
    std::vector<InstanceView> changed = list;
    change(changed[2]);
    return lengths(changed);
  };
  const Lengths split{2, 1, 3};
  const ClipPlane plane{};
  EXPECT_EQ(with([](InstanceView& i) { i.opacity = 0.5F; }), split);
  EXPECT_EQ(with([](InstanceView& i) { i.material = 0; }), split);
  EXPECT_EQ(with([](InstanceView& i) { i.visible = false; }), split);
  EXPECT_EQ(with([](InstanceView& i) { i.winding = Winding::either; }), split);
  EXPECT_EQ(with([](InstanceView& i) { i.color = Vec4{1, 1, 1, 1}; }), split);
  EXPECT_EQ(with([&](InstanceView& i) { i.clip_planes = std::span(&plane, 1); }), split);
  EXPECT_EQ(with([&](InstanceView& i) { i.geometry = elsewhere; }), split);
  EXPECT_EQ(with([&](InstanceView& i) { i.geometry = second; }), split);
  EXPECT_EQ(with([&](InstanceView& i) { i.geometry = spheres; }), split);
  EXPECT_EQ(with([](InstanceView& i) { i.object_to_world.m[0][0] = -1; }), split);
  EXPECT_EQ(with([](InstanceView& i) { i.scalar = 3; }), split);
  EXPECT_EQ(with([](InstanceView& i) { i.id = 7; }), Lengths{6});
  EXPECT_EQ(with([&](InstanceView& i) { i.geometry = twin; }), Lengths{6});
  EXPECT_EQ(with([](InstanceView& i) { i.object_to_world.m[0][3] = 2; }), Lengths{6});
  for (InstanceView& i : list) i.color = Vec4{0.2F, 0.3F, 0.4F, 1};
  EXPECT_EQ(with([](InstanceView& i) { i.color = Vec4{1, 0, 1, 1}; }), Lengths{6});
  EXPECT_EQ(with([](InstanceView& i) { i.color = Vec4{1, 0, 1, 0.5F}; }), split);
  EXPECT_EQ(with([](InstanceView& i) { i.color = Vec4{std::nanf(""), 0, 1, 1}; }), split);
}

TEST(InstanceRuns, CutAViewOnceForAllThatShowIt) {
  const std::vector<Vec3> arrow{{2, -1, 0}, {0, 2, 0}, {-2, -1, 0}, {0, 0, 0}};
  const MeshView mesh{.positions = arrow, .faces = {FaceKind::polygons, {}}}, twin = mesh;
  std::vector<InstanceView> list(4, InstanceView{mesh});
  list[1].opacity = list[2].opacity = 0.5F;
  list[3].geometry = twin;
  InstanceRuns runs({list, {}, {}}, true, nullptr);
  runs.cut_faces(nullptr);
  const std::span<const InstanceView> firsts = runs.firsts().instances;
  ASSERT_EQ(firsts.size(), 3U);
  ASSERT_NE(firsts[0].mesh()->cuts, nullptr);
  EXPECT_EQ(firsts[1].mesh(), firsts[0].mesh());
  EXPECT_EQ(firsts[2].mesh()->cuts, firsts[0].mesh()->cuts);
  EXPECT_EQ(mesh.cuts, nullptr) << "the caller's view stays as it is";
}

TEST(InstanceRuns, OfManyInstancesAreFoundByThreads) {
  const Arrays one(1), other(1);
  const MeshView mesh = one.view(5), elsewhere = other.view(5);
  std::vector<InstanceView> list;
  for (std::size_t i = 0; i < 30000; ++i)
    list.push_back({.geometry = i / 10000 == 1 ? elsewhere : mesh});
  parallel::Threads threads(3);
  const InstanceRuns runs({list, {}, {}}, true, &threads);
  ASSERT_EQ(runs.firsts().instances.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(runs.length(i), 10000U);
    EXPECT_EQ(runs.number(i), i * 10000);
    EXPECT_EQ(runs.instances(i), list.data() + i * 10000);
  }
}

}  // namespace
}  // namespace rastrum::test::instance_runs_test
