// SPDX-License-Identifier: BSD-3-Clause
// Skins, morph targets and animations of glTF, against a plain oracle in long double.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/error.hpp>
#include <rastrum/io.hpp>

#include "tests/io/gltf_document.hpp"
#include "tests/io/scene_files.hpp"

namespace rastrum::test::gltf_motion_test {
namespace {

using Real = long double;
using Row = std::array<Real, 4>;
using Matrix = std::array<Row, 4>;
using Vector = std::array<Real, 3>;

Scene read(const std::string& text) {
  return read_file("a.gltf", text);
}

/// Numbers as JSON, exact to the last bit.
template <class T>
std::string list(const std::vector<T>& values) {
  std::string r = "[";
  for (const T v : values) {
    std::array<char, 40> text{};
    std::snprintf(text.data(), text.size(), "%s%.17g", r.size() > 1 ? "," : "",
                  static_cast<double>(v));
    r += text.data();
  }
  return r + "]";
}

Matrix product(const Matrix& a, const Matrix& b) {
  Matrix r{};
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j)
      for (std::size_t k = 0; k < 4; ++k) r[i][j] += a[i][k] * b[k][j];
  return r;
}

/// q v q*, by cross products.
Vector turned(const std::array<Real, 4>& xyzw, const Vector& v) {
  const auto& [x, y, z, w] = xyzw;
  const auto cross = [](const Vector& a, const Vector& b) {
    return Vector{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  };
  const Vector u{x, y, z};
  const Vector once = cross(u, v), twice = cross(u, once);
  Vector r{};
  for (std::size_t i = 0; i < 3; ++i) r[i] = v[i] + 2 * (w * once[i] + twice[i]);
  return r;
}

struct Placement {
  std::vector<double> t{0, 0, 0}, q{0, 0, 0, 1}, s{1, 1, 1};

  [[nodiscard]] Matrix matrix() const {
    Real l = 0;
    for (const double x : q) l += static_cast<Real>(x) * x;
    l = std::sqrt(l);
    Matrix m{};
    for (std::size_t j = 0; j < 3; ++j) {
      Vector axis{};
      axis[j] = s[j];
      const Vector v = turned({q[0] / l, q[1] / l, q[2] / l, q[3] / l}, axis);
      for (std::size_t i = 0; i < 3; ++i) m[i][j] = v[i];
      m[j][3] = t[j];
    }
    m[3][3] = 1;
    return m;
  }
  [[nodiscard]] std::string json() const {
    return R"("translation":)" + list(t) + R"(,"rotation":)" + list(q) + R"(,"scale":)" + list(s);
  }
};

/// Within an ulp, because the oracle's own rounding may differ.
void expect_rounded(float got, Real exact, Real magnitude) {
  const auto ulp = static_cast<Real>(std::numeric_limits<float>::epsilon());
  EXPECT_LE(std::abs(got - exact), ulp * std::max(std::abs(exact), magnitude * 1e-7L));
}

/// A skeleton of five joints in a chain, with unrelated nodes beside, and a cloud of triangles that
/// are morphed and then follow up to eight joints each.
struct Skeleton {
  static constexpr std::size_t kJoints = 5, kVertices = 90;
  std::mt19937 random{7};
  std::vector<Placement> places;
  std::vector<float> bind, positions, normals, displacements;
  std::vector<std::uint8_t> joints[2], weights0;
  std::vector<float> weights1;

  float in(float low, float high) {
    return std::uniform_real_distribution<float>(low, high)(random);
  }

  Skeleton() {
    for (std::size_t j = 0; j < kJoints; ++j) {
      Placement p;
      for (std::size_t i = 0; i < 3; ++i) p.t[i] = double{in(-1, 1)};
      for (std::size_t i = 0; i < 4; ++i) p.q[i] = double{in(-1, 1)};
      for (std::size_t i = 0; i < 3; ++i) p.s[i] = double{in(0.5F, 2)};
      if (j == kJoints - 1) p.s[0] = -p.s[0];  // a mirror image
      places.push_back(p);
      for (int k = 0; k < 16; ++k)
        bind.push_back(k == 15      ? 1.0F
                       : k % 4 == 3 ? 0.0F
                       : k % 5 == 0 ? in(0.5F, 1.5F)
                                    : in(-0.3F, 0.3F));
    }
    for (std::size_t v = 0; v < kVertices; ++v) {
      for (int k = 0; k < 3; ++k) positions.push_back(in(-2, 2));
      for (int k = 0; k < 3; ++k) displacements.push_back(in(-1, 1));
      Vec3 n = normalize(Vec3{in(-1, 1), in(-1, 1), in(0.1F, 1)});
      normals.insert(normals.end(), {n.x, n.y, n.z});
      for (int k = 0; k < 4; ++k) {
        for (auto& j : joints) j.push_back(static_cast<std::uint8_t>(random() % kJoints));
        weights0.push_back(static_cast<std::uint8_t>(v % 3 == 0 && k > 1 ? 0 : random() % 255 + 1));
        weights1.push_back(v % 2 == 0 ? 0 : in(0, 1));
      }
    }
  }

  /// Node 0 has the mesh, away from the joints; node 1 is joint 0's parent.
  [[nodiscard]] std::string text() const {
    GltfDocument d;
    d.floats(positions, "VEC3");
    d.floats(normals, "VEC3");
    d.add(joints[0], "VEC4", 5121);
    d.add(weights0, "VEC4", 5121, true);
    d.add(std::vector<std::uint16_t>(joints[1].begin(), joints[1].end()), "VEC4", 5123);
    d.floats(weights1, "VEC4");
    d.floats(bind, "MAT4");
    d.floats(displacements, "VEC3");
    std::string nodes =
        R"([{"mesh":0,"skin":0,"translation":[100,0,0]},{"children":[2],"scale":[2,2,2]})";
    std::string ids;
    for (std::size_t j = 0; j < kJoints; ++j) {
      nodes += ",{" + places[j].json();
      if (j + 1 < kJoints) nodes += R"(,"children":[)" + std::to_string(j + 3) + "]";
      nodes += "}";
      ids += (j == 0 ? "" : ",") + std::to_string(j + 2);
    }
    return d.text(
        R"("meshes":[{"primitives":[{"attributes":{"POSITION":0,"NORMAL":1,"JOINTS_0":2,)"
        R"("WEIGHTS_0":3,"JOINTS_1":4,"WEIGHTS_1":5},"targets":[{"POSITION":7}]}],"weights":[0.75]}],"skins":[{"inverseBindMatrices":6,"joints":[)" +
        ids + R"(]}],"nodes":)" + nodes + "]");
  }

  [[nodiscard]] std::vector<Matrix> joint_matrices() const {
    std::vector<Matrix> r;
    Matrix parent = Placement{{0, 0, 0}, {0, 0, 0, 1}, {2, 2, 2}}.matrix();
    for (std::size_t j = 0; j < kJoints; ++j) {
      parent = product(parent, places[j].matrix());
      Matrix b{};
      for (std::size_t k = 0; k < 16; ++k) b[k % 4][k / 4] = bind[16 * j + k];
      r.push_back(product(parent, b));
    }
    return r;
  }
};

TEST(GltfMotion, SkinsArePosedAtRest) {
  const Skeleton skeleton;
  const Scene scene = read(skeleton.text());
  ASSERT_EQ(scene.meshes.size(), 1U);
  const Mesh& mesh = scene.meshes[0];
  ASSERT_EQ(mesh.positions.size(), Skeleton::kVertices);
  std::size_t mirrored = 0;
  EXPECT_EQ(scene.instances[0].object_to_world.m[0][3], 0)
      << "the node of a skinned mesh is ignored";
  const std::vector<Matrix> matrices = skeleton.joint_matrices();
  for (std::size_t v = 0; v < Skeleton::kVertices; ++v) {
    Matrix m{};
    Real sum = 0;
    for (std::size_t k = 0; k < 8; ++k) {
      const std::size_t at = 4 * v + k % 4;
      const Real w = k < 4 ? static_cast<Real>(static_cast<float>(skeleton.weights0[at]) / 255.0F)
                           : static_cast<Real>(skeleton.weights1[at]);
      sum += w;
      for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < 4; ++j)
          m[i][j] += w * matrices[skeleton.joints[k / 4][at]][i][j];
    }
    const float got[3] = {mesh.positions[v].x, mesh.positions[v].y, mesh.positions[v].z};
    for (std::size_t i = 0; i < 3; ++i) {
      Real exact = m[i][3];
      for (std::size_t j = 0; j < 3; ++j)
        exact += m[i][j] * (skeleton.positions[3 * v + j] +
                            static_cast<Real>(0.75F) * skeleton.displacements[3 * v + j]);
      expect_rounded(got[i], exact / sum, 10);
    }
    Real determinant = 0;
    for (std::size_t i = 0; i < 3; ++i)
      determinant +=
          m[0][i] * (m[1][(i + 1) % 3] * m[2][(i + 2) % 3] - m[1][(i + 2) % 3] * m[2][(i + 1) % 3]);
    mirrored += determinant < 0 ? 1U : 0U;
    // A normal stays perpendicular to its surface, on the same side.
    const Vec3 before{skeleton.normals[3 * v], skeleton.normals[3 * v + 1],
                      skeleton.normals[3 * v + 2]};
    const Vec3 side = normalize(cross(before, Vec3{0.3F, 0.9F, -0.2F}));
    const auto moved = [&](Vec3 d) {
      Vec3d r;
      r.x = static_cast<double>(m[0][0] * d.x + m[0][1] * d.y + m[0][2] * d.z);
      r.y = static_cast<double>(m[1][0] * d.x + m[1][1] * d.y + m[1][2] * d.z);
      r.z = static_cast<double>(m[2][0] * d.x + m[2][1] * d.y + m[2][2] * d.z);
      return normalize(r);
    };
    const Vec3d n = Vec3d(mesh.normals.values[v]);
    EXPECT_NEAR(length(n), 1, 1e-6);
    for (const Vec3 tangent : {side, normalize(cross(before, side))})
      EXPECT_NEAR(dot(n, moved(tangent)), 0, 2e-6);
    EXPECT_GT(dot(n, moved(before)), 0);
  }
  EXPECT_GT(mirrored, 3U);
  EXPECT_LT(mirrored, Skeleton::kVertices);
}

/// A triangle on node 0 with an animated `path`: keys at 1, 2 and 4 s.
std::string animated(const char* path, const char* interpolation, const std::vector<float>& values,
                     const char* type) {
  GltfDocument d;
  d.floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
  d.floats({1, 2, 4}, "SCALAR");
  d.floats(values, type);
  return d.text(
      std::string(
          R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"nodes":[{"mesh":0}],)"
          R"("animations":[{"name":"go","samplers":[{"input":1,"output":2,"interpolation":")") +
      interpolation + R"("}],"channels":[{"sampler":0,"target":{"node":0,"path":")" + path +
      R"("}}]}])");
}

Mat4d matrix_at(Scene& scene, double seconds) {
  EXPECT_TRUE(pose(scene, seconds).empty()) << "no vertex moves by itself";
  return scene.instances[0].object_to_world;
}

TEST(GltfMotion, KeysAreHeldJoinedOrCurved) {
  const std::vector<float> keys = {0, 0, 1, 3, 0, 1, 3, 8, 1};
  Scene linear = read(animated("translation", "LINEAR", keys, "VEC3"));
  EXPECT_EQ(linear.instances[0].object_to_world.m[2][3], 0) << "at rest, which is no key";
  EXPECT_EQ(matrix_at(linear, 0.5).m[2][3], 1) << "before the first key";
  EXPECT_EQ(matrix_at(linear, 1.25).m[0][3], 0.75);
  EXPECT_EQ(matrix_at(linear, 2).m[0][3], 3);
  EXPECT_EQ(matrix_at(linear, 3.5).m[1][3], 6);
  EXPECT_EQ(matrix_at(linear, 4).m[1][3], 8) << "the end belongs to the animation";
  EXPECT_EQ(matrix_at(linear, 4 + 1.25).m[0][3], 0.75) << "then it begins again";
  EXPECT_EQ(matrix_at(linear, 12).m[1][3], 8);
  EXPECT_EQ(matrix_at(linear, -3).m[2][3], 1);

  Scene step = read(animated("translation", "STEP", keys, "VEC3"));
  EXPECT_EQ(matrix_at(step, 1.999).m[0][3], 0);
  EXPECT_EQ(matrix_at(step, 2).m[0][3], 3);
  EXPECT_EQ(matrix_at(step, 3.999).m[1][3], 0);

  // In-tangent, value, out-tangent: over 2 s from 3 at 1 a second to 8 at −2 a second.
  Scene cubic = read(animated(
      "translation", "CUBICSPLINE",
      {0, 0, 0, 0, 0, 0, 0, 0, 0, 9, 9, 9, 3, 0, 0, 1, 0, 0, -2, 0, 0, 8, 0, 0, 9, 9, 9}, "VEC3"));
  EXPECT_EQ(matrix_at(cubic, 2).m[0][3], 3);
  EXPECT_EQ(matrix_at(cubic, 4).m[0][3], 8);
  // At a quarter: 27/32 · 3 + 2 · 9/64 · 1 + 5/32 · 8 + 2 · (−3/64) · (−2).
  EXPECT_NEAR(matrix_at(cubic, 2.5).m[0][3], 27.0 / 32 * 3 + 18.0 / 64 + 40.0 / 32 + 12.0 / 64,
              1e-15);
}

TEST(GltfMotion, RotationsTurnEvenlyTheShorterWay) {
  // 0°, then 90° about z with negated quaternion, then 180° with the other sign again.
  const auto h = static_cast<float>(std::numbers::sqrt2 / 2);
  Scene scene =
      read(animated("rotation", "LINEAR", {0, 0, 0, 2, 0, 0, -h, -h, 0, 0, 1, 0}, "VEC4"));
  for (const auto& [seconds, degrees] :
       {std::pair{1 + 1.0 / 3, 30.0}, {1.5, 45.0}, {2.0, 90.0}, {3.0, 135.0}, {4.0, 180.0}}) {
    const Mat4d m = matrix_at(scene, seconds);
    const double angle = degrees * std::numbers::pi / 180;
    EXPECT_NEAR(m.m[0][0], std::cos(angle), 1e-7) << seconds;
    EXPECT_NEAR(m.m[1][0], std::sin(angle), 1e-7) << seconds;
    EXPECT_NEAR(m.m[2][2], 1, 1e-15);
  }
}

/// Two targets on a triangle with normals; `mesh`, `node` and `more` are further members.
std::string morphed(const std::string& mesh, const std::string& nodes,
                    const std::string& more = "") {
  GltfDocument d;
  d.floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
  d.floats({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
  d.floats({0, 0, 0, 0, 0, 0, 0, 0, 2}, "VEC3");
  d.floats({0, 0, 0, 0, 0, 0, 0, 4, -1}, "VEC3");
  d.floats({8, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC3");
  d.floats({0, 1}, "SCALAR");
  d.floats({0, 0, 0.5F, 0.25F}, "SCALAR");
  return d.text(R"("meshes":[{"primitives":[{"attributes":{"POSITION":0,"NORMAL":1},)"
                R"("targets":[{"POSITION":2,"NORMAL":3},{"POSITION":4}]}])" +
                mesh + R"(}],"nodes":)" + nodes + more);
}
constexpr const char* kMoveWeights =
    R"(,"animations":[{"samplers":[{"input":5,"output":6}],)"
    R"("channels":[{"sampler":0,"target":{"node":0,"path":"weights"}}]}])";

TEST(GltfMotion, MorphTargetsByTheWeightsOfMeshNodeAndAnimation) {
  const Scene none = read(morphed("", R"([{"mesh":0}])"));
  EXPECT_EQ(none.meshes[0].positions[2], (Vec3{0, 1, 0}));

  const Scene by_mesh = read(morphed(R"(,"weights":[0.5,0])", R"([{"mesh":0}])"));
  EXPECT_EQ(by_mesh.meshes[0].positions[2], (Vec3{0, 1, 1}));
  EXPECT_EQ(by_mesh.meshes[0].positions[0], (Vec3{0, 0, 0}));
  // (0, 2, 0.5), normalized
  const Vec3 n = by_mesh.meshes[0].normals.values[2];
  EXPECT_FLOAT_EQ(n.y, 2 / std::sqrt(4.25F));
  EXPECT_FLOAT_EQ(n.z, 0.5F / std::sqrt(4.25F));

  const Scene by_node = read(
      morphed(R"(,"weights":[0.5,0])", R"([{"mesh":0,"weights":[0,1]},{"mesh":0},{"mesh":0}])"));
  ASSERT_EQ(by_node.meshes.size(), 2U) << "two nodes share the mesh's own weights";
  EXPECT_EQ(by_node.instances[1].mesh, by_node.instances[2].mesh);
  const Mesh& first = by_node.meshes[by_node.instances[0].mesh];
  EXPECT_EQ(first.positions[0], (Vec3{8, 0, 0}));
  EXPECT_EQ(first.positions[2], (Vec3{0, 1, 0}));
  EXPECT_EQ(by_node.meshes[by_node.instances[1].mesh].positions[2], (Vec3{0, 1, 1}));

  Scene moving =
      read(morphed("", R"([{"mesh":0,"translation":[0,0,5]},{"mesh":0}])", kMoveWeights));
  ASSERT_EQ(moving.meshes.size(), 2U);
  const Vec3* const still = moving.meshes[moving.instances[1].mesh].positions.data();
  EXPECT_EQ(pose(moving, 0.5), (std::vector<std::uint32_t>{0, 1}));
  const Mesh& posed = moving.meshes[moving.instances[0].mesh];
  EXPECT_EQ(posed.positions[2], (Vec3{0, 1, 0.5F}));
  EXPECT_EQ(posed.positions[0], (Vec3{1, 0, 0}));
  EXPECT_EQ(moving.meshes[moving.instances[1].mesh].positions[2], (Vec3{0, 1, 0}));
  EXPECT_EQ(moving.meshes[moving.instances[1].mesh].positions.data(), still) << "views stay";
  EXPECT_EQ(moving.instances[0].object_to_world.m[2][3], 5);
  pose_at_rest(moving);
  EXPECT_EQ(posed.positions[2], (Vec3{0, 1, 0}));
}

TEST(GltfMotion, MeshesWithoutNormalsKeepNone) {
  Scene scene = read(changed(morphed("", R"([{"mesh":0}])", kMoveWeights), R"(,"NORMAL":1)", ""));
  scene.meshes[0].normals.values.resize(3, Vec3{1, 0, 0});  // like normals that a program computes
  pose(scene, 1);
  EXPECT_TRUE(scene.meshes[0].normals.empty());
}

TEST(GltfMotion, FilesMoveWhereTheyArePlacedAndAppended) {
  const std::string text = animated("translation", "LINEAR", {0, 0, 0, 3, 0, 0, 3, 8, 0}, "VEC3");
  Scene all = read(text);
  Scene other = read(text);
  Mat4d place = Mat4d::identity();
  place.m[0][0] = 2;
  place.m[2][3] = 7;
  other.place(place);
  all.append(std::move(other));
  all.append(read(morphed("", R"([{"mesh":0}])", kMoveWeights)));
  Scene still = read(morphed("", R"([{"mesh":0}])"));
  still.append(std::move(all));
  EXPECT_EQ(pose(still, 1.5), (std::vector<std::uint32_t>{0, 3}));
  ASSERT_EQ(still.instances.size(), 4U);
  EXPECT_EQ(still.instances[1].object_to_world.m[0][3], 1.5);
  EXPECT_EQ(still.instances[2].object_to_world.m[0][3], 3);
  EXPECT_EQ(still.instances[2].object_to_world.m[2][3], 7);
  EXPECT_EQ(still.meshes[3].positions[2].z, 0.5F) << "half a second into the second round";
  EXPECT_EQ(still.meshes[0].positions[2].z, 0) << "a file without animations is at rest";
  expect_refused("", [&] { pose(still, 0, 1); });
  EXPECT_THROW(pose(still, std::numeric_limits<double>::quiet_NaN()), Error);
}

TEST(GltfMotion, CamerasMoveWithTheirNodes) {
  std::string text = changed(animated("translation", "LINEAR", {0, 0, 0, 3, 0, 0, 3, 8, 0}, "VEC3"),
                             R"([{"mesh":0)", R"([{"camera":0)");
  text.insert(text.size() - 1,
              R"(,"cameras":[{"type":"perspective","perspective":{"yfov":1,"znear":0.25}}])");
  Scene scene = read(text);
  pose(scene, 3);
  EXPECT_EQ(scene.cameras[0].eye.y, 4.0F);
  EXPECT_EQ(scene.cameras[0].near_plane, 0.25F);
}

TEST(GltfMotion, DescribeListsAnimations) {
  EXPECT_TRUE(
      holds(io::describe(read(animated("scale", "STEP", {1, 1, 1, 2, 2, 2, 1, 1, 1}, "VEC3"))),
            "animation 0 go: 4 s"));
}

TEST(GltfMotion, ErrorsNameThePlace) {
  const std::vector<float> keys = {0, 0, 1, 3, 0, 1, 3, 8, 1};
  const std::string skin = Skeleton().text(), still = morphed("", R"([{"mesh":0}])"),
                    moves = animated("translation", "LINEAR", keys, "VEC3"),
                    channel = R"({"sampler":0,"target":{"node":0,"path":"translation"}})";
  const struct {
    std::string text, from, to, says;
  } kMistakes[] = {
      {skin, R"("joints":[2,3,4,5,6])", R"("joints":[2,3])",
       "nodes[0].skin: has 2 joints, but its mesh refers to joint"},
      {skin, R"(,"WEIGHTS_1":5)", "", "only one of JOINTS_1 and WEIGHTS_1"},
      {skin, R"("inverseBindMatrices":6)", R"("inverseBindMatrices":5)", "accessors[5]"},
      {skin, R"("JOINTS_1":4)", R"("JOINTS_1":5)", "unsigned bytes or shorts"},
      {skin, R"("WEIGHTS_0":3)", R"("WEIGHTS_0":0)", "wrong type"},
      {moves, "LINEAR", "CUBIC", "samplers[0].interpolation"},
      {moves, "LINEAR", "CUBICSPLINE", "accessors[2]: has 3 elements, but there are 3 keys of 3"},
      {moves, "translation", "rotation", "accessors[2]: has the wrong type"},
      {moves, "translation", "weights", "no morph targets"},
      {moves, R"("nodes":[{"mesh":0})",
       R"("nodes":[{"mesh":0,"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]})",
       "channels[0].target.node: has a matrix"},
      {moves, R"("input":1)", R"("input":0)", "accessors[0]: is read as times"},
      {moves, channel, channel + "," + channel, "channels[1]: moves what another"},
      {morphed(R"(,"weights":[0.5])", R"([{"mesh":0}])"), "", "",
       "meshes[0].weights: has 1 numbers"},
      {morphed("", R"([{"mesh":0,"weights":[1,2,3]}])"), "", "", "nodes[0].weights: has 3 numbers"},
      {still, R"({"POSITION":4})", R"({"POSITION":5})", "accessors[5]"},
  };
  for (const auto& [text, from, to, says] : kMistakes)
    expect_bad_file(says, "a.gltf", changed(text, from, to));
  GltfDocument d;
  d.floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
  d.floats({1, 1, 4}, "SCALAR");
  d.floats(keys, "VEC3");
  const std::string rest = moves.substr(moves.find(R"("meshes")"));
  expect_bad_file("time 1 does not rise", "a.gltf", d.text(rest.substr(0, rest.size() - 1)));
}

}  // namespace
}  // namespace rastrum::test::gltf_motion_test
