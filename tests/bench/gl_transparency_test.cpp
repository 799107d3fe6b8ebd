// SPDX-License-Identifier: BSD-3-Clause
// Compares OpenGL's three ways of transparency with layers that the test blends, before Rastrum is
// compared with them.
#include <bench/peers/compare.hpp>
#include <bench/peers/gl_transparency.hpp>
#include <bench/peers/vtk_peer.hpp>
#include <bench/scenes.hpp>
#include <bench/stand_ins.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/error.hpp>

#include "tests/bench/gl_fixture.hpp"

namespace rastrum::bench::gl_transparency_test {
namespace {

/// A rectangle over columns [from, width) of the window, with one depth and normal.
struct Layer {
  int from = 0;
  float z = 0;
  Vec3 normal{0, 0, 1};
};

/// `phong` of a fragment seen from (0, 0, 1), in float64.
std::array<double, 3> phong(Vec3 n) {
  const double light_length = std::sqrt(0.4 * 0.4 + 0.6 * 0.6 + 1.0);
  const double l[3] = {0.4 / light_length, 0.6 / light_length, 1 / light_length};
  double h[3] = {l[0], l[1], l[2] + 1};
  const double h_length = std::sqrt(h[0] * h[0] + h[1] * h[1] + h[2] * h[2]);
  const double n_length = std::sqrt(static_cast<double>(dot(n, n)));
  const auto against = [&](const double(&v)[3], double length) {
    return std::max(0.0, (static_cast<double>(n.x) * v[0] + static_cast<double>(n.y) * v[1] +
                          static_cast<double>(n.z) * v[2]) /
                             (n_length * length));
  };
  const double diffuse = 0.1 + 0.8 * against(l, 1);
  const double highlight = 0.3 * std::pow(against(h, h_length), 32);
  return {0.8 * diffuse + highlight, 0.7 * diffuse + highlight, 0.6 * diffuse + highlight};
}

/// `layers` in random order, each from another column on, at distinct depths.
std::vector<Layer> random_layers(int count, int width, std::uint64_t seed) {
  std::mt19937_64 bits(seed);
  std::vector<Layer> layers;
  for (int i = 0; i < count; ++i) {
    const auto unit = [&] { return static_cast<float>(bits() >> 40) * 0x1p-24F; };
    const float z = -0.05F - 0.9F * (static_cast<float>(i) + 0.5F) / static_cast<float>(count);
    layers.push_back({static_cast<int>(unit() * static_cast<float>(width)),
                      z,
                      {unit() - 0.5F, unit() - 0.5F, 0.3F + unit()}});
  }
  for (std::size_t i = layers.size(); i > 1; --i) std::swap(layers[i - 1], layers[bits() % i]);
  return layers;
}

Mesh mesh_of(const std::vector<Layer>& layers, int width, int height) {
  Mesh mesh;
  for (const Layer& layer : layers) {
    const auto base = static_cast<std::uint32_t>(mesh.positions.size());
    const auto left = static_cast<float>(layer.from), right = static_cast<float>(width);
    const auto top = static_cast<float>(height);
    for (const Vec3 p : {Vec3{left, 0, layer.z}, Vec3{right, 0, layer.z}, Vec3{right, top, layer.z},
                         Vec3{left, top, layer.z}}) {
      mesh.positions.push_back(p);
      mesh.normals.values.push_back(layer.normal);
    }
    mesh.indices.insert(mesh.indices.end(), {base, base + 1, base + 2, base, base + 2, base + 3});
  }
  return mesh;
}

/// A row of the picture; all rows are equal. `sorted`: the nearest in front, of equals the first
/// submitted; otherwise the last submitted in front.
std::vector<std::array<double, 4>> blended(std::vector<Layer> layers, int width, double opacity,
                                           bool sorted) {
  if (sorted)
    std::ranges::stable_sort(layers, std::ranges::greater{}, &Layer::z);
  else
    std::ranges::reverse(layers);
  std::vector<std::array<double, 4>> row(static_cast<std::size_t>(width));
  for (const Layer& layer : layers) {
    const auto c = phong(layer.normal);
    for (auto x = static_cast<std::size_t>(layer.from); x < row.size(); ++x) {
      const double left = (1 - row[x][3]) * opacity;
      for (std::size_t i = 0; i < 3; ++i) row[x][i] += left * c[i];
      row[x][3] += left;
    }
  }
  return row;
}

class GlTransparencyTest : public GlFixture<GlTransparency> {
 protected:
  void show(const std::vector<Layer>& layers, int width, int height) {
    gl_->set_mesh(mesh_of(layers, width, height).view());
    gl_->set_view(window_camera(width, height), width, height);
  }

  /// The largest difference of a channel between `row` and the last picture.
  double worst(const std::vector<std::array<double, 4>>& row) {
    const Image<Vec4> picture = gl_->picture();
    double most = 0;
    for (int y = 0; y < picture.height(); ++y)
      for (int x = 0; x < picture.width(); ++x) {
        const Vec4 p = picture(x, y);
        const auto& e = row[static_cast<std::size_t>(x)];
        for (const double d : {p.x - e[0], p.y - e[1], p.z - e[2], p.w - e[3]})
          most = std::max(most, std::abs(d));
      }
    return most;
  }
};

// Half floats in [0.5, 1.1) are at most 2⁻¹⁰ apart.
constexpr double kHalf = 1e-3, kFloat = 2e-5;

TEST_F(GlTransparencyTest, BlendsAnyNumberOfLayers) {
  constexpr int kWidth = 96, kHeight = 24;
  for (const int count : {1, 2, 7, 64, 65, 150})
    for (const float opacity : {0.02F, 0.5F, 1.0F}) {
      const auto layers = random_layers(count, kWidth, static_cast<std::uint64_t>(count));
      show(layers, kWidth, kHeight);
      const auto in_order = blended(layers, kWidth, static_cast<double>(opacity), true);
      std::size_t deepest = 0, fragments = 0;
      for (std::size_t x = 0; x < kWidth; ++x) {
        const auto here = static_cast<std::size_t>(std::ranges::count_if(
            layers, [&](const Layer& l) { return static_cast<std::size_t>(l.from) <= x; }));
        deepest = std::max(deepest, here);
        fragments += here * kHeight;
      }
      EXPECT_EQ(gl_->fragments(), fragments);
      gl_->draw(GlBlending::unsorted, opacity, GlPrecision::float32);
      EXPECT_LT(worst(blended(layers, kWidth, static_cast<double>(opacity), false)), kFloat)
          << count << " layers, opacity " << opacity;
      gl_->draw(GlBlending::lists, opacity, GlPrecision::float32);
      EXPECT_LT(worst(in_order), kHalf) << count << " layers, opacity " << opacity;
      const auto frame = gl_->draw(GlBlending::peeling, opacity, GlPrecision::float32);
      EXPECT_LT(worst(in_order), kFloat) << count << " layers, opacity " << opacity;
      EXPECT_TRUE(frame.complete);
      EXPECT_EQ(static_cast<std::size_t>(frame.passes), deepest + 1);
    }
}

TEST_F(GlTransparencyTest, ListsPutTheFirstSubmittedOfEqualDepthsInFront) {
  constexpr int kWidth = 16, kHeight = 16;
  std::vector<Layer> layers = random_layers(150, kWidth, 3);
  for (Layer& layer : layers) layer.z = layer.z < -0.3F ? -0.5F : -0.25F;
  show(layers, kWidth, kHeight);
  gl_->draw(GlBlending::lists, 0.05F, GlPrecision::float32);
  EXPECT_LT(worst(blended(layers, kWidth, 0.05, true)), kHalf);
}

TEST_F(GlTransparencyTest, ListsFillSeveralBuffers) {
  constexpr int kSize = 512;
  std::vector<Layer> layers = random_layers(40, kSize, 4);
  for (Layer& layer : layers) layer.from = 0;
  show(layers, kSize, kSize);
  EXPECT_EQ(gl_->fragments(), 40U * kSize * kSize);
  gl_->draw(GlBlending::lists, 0.2F, GlPrecision::float32);
  EXPECT_LT(worst(blended(layers, kSize, 0.2, true)), kHalf);
}

TEST_F(GlTransparencyTest, RgbaIsWithinItsQuantization) {
  constexpr int kWidth = 64, kHeight = 16, kLayers = 6;
  const auto layers = random_layers(kLayers, kWidth, 5);
  show(layers, kWidth, kHeight);
  for (const auto method : {GlBlending::unsorted, GlBlending::lists, GlBlending::peeling}) {
    gl_->draw(method, 0.4F, GlPrecision::rgba8);
    auto row = blended(layers, kWidth, 0.4, method != GlBlending::unsorted);
    for (auto& pixel : row)
      for (double& v : pixel) v = std::min(v, 1.0);
    EXPECT_LT(worst(row), kLayers * 1.5 / 255) << name(method);
    EXPECT_GT(worst(row), 0.2 / 255) << name(method);  // it is quantized
  }
}

TEST_F(GlTransparencyTest, PeelingRunsOutOfPatience) {
  show(random_layers(20, 16, 6), 16, 16);
  const auto frame = gl_->draw(GlBlending::peeling, 0.5F, GlPrecision::rgba8, 0);
  EXPECT_FALSE(frame.complete);
  EXPECT_EQ(frame.passes, 1);
}

TEST_F(GlTransparencyTest, BothExactWaysAgreeOnMeshes) {
  for (const char* scene : {"torus-knot", "gyroid"}) {
    const Mesh mesh = load(scene_by_name(scene));
    gl_->set_mesh(mesh.view());
    gl_->set_view(whole_view(mesh), 400, 300);
    gl_->draw(GlBlending::lists, 0.5F, GlPrecision::float32);
    const Image<Vec4> lists = gl_->picture();
    gl_->draw(GlBlending::peeling, 0.5F, GlPrecision::float32);
    const PictureError error = picture_error(lists, gl_->picture(), 1.0 / 255);
    EXPECT_GT(error.covered, 20'000U);
    EXPECT_GE(error.share(), 0.999) << scene;
  }
}

TEST_F(GlTransparencyTest, VtkDrawsTheSame) {
  Started<VtkPeer> started(2);
  std::optional<VtkPeer>& vtk = started.peer;
  if (!vtk) GTEST_SKIP() << started.note;
  const Mesh mesh = load(scene_by_name("torus-knot"));
  gl_->set_mesh(mesh.view());
  vtk->set_mesh(mesh.view());
  // The field of view is the smaller side's: a wide picture, then a high one.
  for (const auto& [width, height] : {std::pair{400, 300}, {300, 400}}) {
    gl_->set_view(whole_view(mesh), width, height);
    gl_->draw(GlBlending::unsorted, 0.5F, GlPrecision::float32);
    const Image<Vec4> unsorted = gl_->picture();
    gl_->draw(GlBlending::lists, 0.5F, GlPrecision::float32);
    vtk->set_view(whole_view(mesh), width, height);
    vtk->draw(0.5F);
    const Image<Vec4> picture = vtk->picture();
    const PictureError error = picture_error(gl_->picture(), picture, 4.0 / 255);
    EXPECT_GT(error.covered, 20'000U);
    EXPECT_GE(error.share(), 0.99);
    EXPECT_LT(picture_error(unsorted, picture, 4.0 / 255).share(), 0.9);
  }
}

}  // namespace
}  // namespace rastrum::bench::gl_transparency_test
