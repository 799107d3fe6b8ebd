// Prepared meshes draw the same bits as they do unprepared.
#include <rastrum/prepared_mesh.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <deque>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/error.hpp>
#include <rastrum/io.hpp>
#include <rastrum/render.hpp>
#include <rastrum/scene/mesh_clusters.hpp>
#include <rastrum/shapes.hpp>
#include <rastrum/transform.hpp>

#include "tests/support/directories.hpp"
#include "tests/support/random.hpp"
#include "tests/support/scenes.hpp"

namespace rastrum::test::prepared_test {
namespace {

struct Pictures {
  Image<Rgba8> color8;
  Image<Vec4> color;
  Image<float> depth;
  Image<std::int64_t> ids;
  FrameStats stats;
};

Pictures draw(Renderer& renderer, const SceneView& scene, const Camera& camera,
              const FrameOptions& o) {
  Pictures p{Image<Rgba8>(o.width, o.height), Image<Vec4>(o.width, o.height),
             Image<float>(o.width, o.height), Image<std::int64_t>(o.width, o.height), {}};
  Targets targets;
  targets.color8 = p.color8;
  targets.color = p.color;
  targets.depth = p.depth;
  targets.ids = p.ids;
  p.stats = renderer.render(scene, camera, o, targets);
  return p;
}

template <class T>
bool are_equal(const Image<T>& a, const Image<T>& b) {
  const auto pa = a.pixels(), pb = b.pixels();
  return pa.size() == pb.size() && std::memcmp(pa.data(), pb.data(), pa.size_bytes()) == 0;
}

void expect_equal(const Pictures& plain, const Pictures& prepared) {
  EXPECT_TRUE(are_equal(plain.ids, prepared.ids));
  EXPECT_TRUE(are_equal(plain.depth, prepared.depth));
  EXPECT_TRUE(are_equal(plain.color8, prepared.color8));
  EXPECT_TRUE(are_equal(plain.color, prepared.color));
  EXPECT_EQ(plain.stats.triangles.input, prepared.stats.triangles.input);
  EXPECT_EQ(plain.stats.triangles.dropped, prepared.stats.triangles.dropped);
  EXPECT_EQ(plain.stats.triangles.clipped, prepared.stats.triangles.clipped);
  EXPECT_EQ(plain.stats.pixels_covered, prepared.stats.pixels_covered);
}

constexpr const char* kOutside = "triangles of clusters outside";
constexpr const char* kAway = "triangles of clusters that face away";
constexpr const char* kHidden = "triangles of hidden clusters";

/// What frames left out, so that a test can say that something was.
class LeftOut {
 public:
  void add(const FrameStats& stats) {
    for (const auto& [name, value] : stats.counters) sum_[name] += value;
  }
  [[nodiscard]] std::uint64_t operator[](const char* name) const {
    const auto found = sum_.find(name);
    return found == sum_.end() ? 0 : found->second;
  }

 private:
  std::map<std::string, std::uint64_t> sum_;
};

/// A scene whose meshes have small clusters, however small they are.
class SmallClusters {
 public:
  SmallClusters(const SceneView& scene, std::uint32_t triangles)
      : instances_(scene.instances.begin(), scene.instances.end()), view_(scene) {
    for (InstanceView& i : instances_)
      if (i.mesh() != nullptr) {
        MeshView mesh = *i.mesh();
        try {
          check_indices(mesh);
        } catch (const Error&) {
          continue;
        }
        mesh.clusters =
            &clusters_.emplace_back(mesh, nullptr, MeshClusters::Way{triangles, true});
        i.geometry = mesh;
      }
    view_.instances = instances_;
  }
  [[nodiscard]] const SceneView& view() const { return view_; }

 private:
  std::deque<MeshClusters> clusters_;
  std::vector<InstanceView> instances_;
  SceneView view_;
};

/// Layers of grids over each other, in tiles that face either way, some behind all.
Scene layers(Random& r) {
  Mesh mesh;
  const int cells = r.integer(2, 10), count = r.integer(2, 6);
  const bool steep = r.chance(0.3);
  for (int layer = 0; layer < count; ++layer) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const double z = r.real(-1, 1), tilt = r.real(-0.5, 0.5) * (steep ? 3 : 1);
    for (int y = 0; y <= cells; ++y)
      for (int x = 0; x <= cells; ++x) {
        const double u = 2.0 * x / cells - 1, v = 2.0 * y / cells - 1;
        const double bump = r.chance(0.05) ? r.real(-0.3, 0.3) : 0;
        mesh.positions.push_back({static_cast<float>(u), static_cast<float>(v),
                                  static_cast<float>(z + tilt * u + bump)});
      }
    for (int y = 0; y < cells; ++y)
      for (int x = 0; x < cells; ++x) {
        const auto at = [&](int i, int j) {
          return first + static_cast<std::uint32_t>((y + j) * (cells + 1) + x + i);
        };
        std::uint32_t t[6] = {at(0, 0), at(1, 0), at(0, 1), at(1, 0), at(1, 1), at(0, 1)};
        if (layer % 2 == 1) {
          std::swap(t[0], t[1]);
          std::swap(t[3], t[4]);
        }
        mesh.indices.insert(mesh.indices.end(), t, t + 6);
      }
  }
  if (r.chance(0.2)) mesh.positions[0].x = std::numeric_limits<float>::quiet_NaN();
  if (r.chance(0.1)) mesh.positions.back().y = std::numeric_limits<float>::infinity();
  Scene scene;
  scene.meshes.push_back(std::move(mesh));
  const int instances = r.integer(1, 5);
  for (int i = 0; i < instances; ++i) {
    Instance& instance = scene.instances.emplace_back();
    auto& m = instance.object_to_world.m;
    for (int row = 0; row < 3; ++row) {
      m[row][row] = r.real(0.3, 1.2) * (r.chance(0.2) ? -1 : 1);
      m[row][3] = i == 0 ? 0 : r.real(-2, 2);
      if (r.chance(0.3)) m[row][(row + 1) % 3] = r.real(-0.5, 0.5);
    }
  }
  return scene;
}

Camera any_camera(Random& r) {
  Camera c;
  c.eye = {r.real(-3, 3), r.real(-3, 3), r.real(0.2, 4)};
  c.target = {r.real(-0.5, 0.5), r.real(-0.5, 0.5), r.real(-0.5, 0.1)};
  c.fov_rad = static_cast<float>(r.real(0.2, 2.0));
  c.near_plane = static_cast<float>(r.real(0.001, 1.0));
  c.orthographic = r.chance(0.25);
  c.orthographic_height = static_cast<float>(r.real(0.3, 6));
  c.far_plane = c.orthographic || r.chance(0.3) ? static_cast<float>(r.real(2, 20))
                                                : std::numeric_limits<float>::infinity();
  return c;
}

/// One scene, some frames along a way, drawn by both.
void compare(std::uint64_t seed, LeftOut& left_out) {
  Random r(seed * 7919 + 1);
  FrameOptions o;
  o.width = r.integer(8, 150);
  o.height = r.integer(8, 120);
  const bool generated = seed % 2 == 0;
  GeneratedScene g;
  if (generated) {
    g = generate(seed / 2, o.width, o.height);
  } else {
    g.kind = "layers";
    g.scene = layers(r);
    g.camera = any_camera(r);
  }
  SCOPED_TRACE(std::to_string(seed) + " " + g.kind);
  o.shader = r.chance(0.5) ? Shader::phong : Shader::flat;
  o.cull = static_cast<Cull>(r.integer(0, 2));
  if (r.chance(0.15)) o.opacity = 0.5F;
  if (r.chance(0.15)) o.samples = r.chance(0.5) ? 4 : 8;
  const auto isas = available_isas();
  RendererOptions how;
  how.threads = r.integer(1, 3);
  how.isa = isas[seed % isas.size()];
  if (r.chance(0.1)) how.memory_limit = std::uint64_t{8} << 20;
  Renderer plain(how), prepared(how);
  const SceneBinding binding(g.scene);
  const SmallClusters clusters(binding.view(), static_cast<std::uint32_t>(r.integer(1, 12)));
  for (int frame = 0; frame < 3; ++frame) {
    const Pictures expected = draw(plain, binding.view(), g.camera, o);
    const Pictures got = draw(prepared, clusters.view(), g.camera, o);
    expect_equal(expected, got);
    left_out.add(got.stats);
    g.camera.eye = g.camera.eye + Vec3d{r.real(-0.1, 0.1), r.real(-0.1, 0.1), r.real(-0.1, 0.1)};
  }
}

void compare_many(std::uint64_t first, std::uint64_t last) {
  LeftOut left_out;
  for (std::uint64_t seed = first; seed < last && !testing::Test::HasFailure(); ++seed)
    compare(seed, left_out);
  if (testing::Test::HasFailure()) return;
  const std::uint64_t n = last - first;
  EXPECT_GT(left_out[kOutside], n);
  EXPECT_GT(left_out[kAway], n);
  EXPECT_GT(left_out[kHidden], n);
}

TEST(Prepared, DrawsTheBitsOfGeneratedScenes) {
  compare_many(0, 400);
}

}  // namespace
}  // namespace rastrum::test::prepared_test
