// SPDX-License-Identifier: BSD-3-Clause
// Scenes of many parts, pictures of them by one renderer and by ranks, and their differences.
#pragma once

#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/ranks.hpp>
#include <rastrum/ranks/gather.hpp>
#include <rastrum/ranks/render_parts.hpp>
#include <rastrum/shapes.hpp>
#include <rastrum/transform.hpp>

#include "tests/support/frame.hpp"
#include "tests/support/random.hpp"

namespace rastrum::test {

/// Images for all targets that ranks can fill, which begin with nonsense.
class AllTargets {
 public:
  AllTargets(int width, int height, bool linear)
      : images_(linear ? ~std::uint32_t{0} : ~ranks::kLinearTarget, {0, 0, width, height}) {
    ranks::each_target(images_.targets(), [](const auto& view, std::uint32_t) {
      if (!view.empty())
        std::memset(static_cast<void*>(view.data), 0x5A,
                    sizeof(*view.data) * static_cast<std::size_t>(view.width) *
                        static_cast<std::size_t>(view.height));
    });
  }
  [[nodiscard]] const Targets& targets() const { return images_.targets(); }

 private:
  ranks::OwnImages images_;
};

/// Compares all pixels of all targets; the message names the first difference.
inline testing::AssertionResult same_targets(const Targets& a, const Targets& b) {
  std::string differs;
  const auto compare = [&](const auto& x, const auto& y, std::string_view name) {
    if (x.empty() != y.empty()) differs.append(" ").append(name).append(" is empty in one;");
    if (x.empty() || y.empty()) return;
    for (int row = 0; row < x.height; ++row)
      for (int column = 0; column < x.width; ++column)
        if (!same_pixel(x(column, row), y(column, row))) {
          differs.append(" ").append(name) +=
              " at (" + std::to_string(column) + ", " + std::to_string(row) + ");";
          return;
        }
  };
  raster::for_each_target([&](const auto& row) {
    if (row.has_ranks()) compare(a.*row.image, b.*row.image, row.name);
  });
  if (differs.empty()) return testing::AssertionSuccess();
  return testing::AssertionFailure() << "targets differ:" << differs;
}

/// A point in the cube from −1 to 1, or in its plane at z. Braces fix the order of evaluation,
/// unlike calls.
inline Vec3 random_point(Random& random, std::optional<float> z = {}) {
  const auto number = [&] { return static_cast<float>(random.real(-1, 1)); };
  return z ? Vec3{number(), number(), *z} : Vec3{number(), number(), number()};
}

/// Meshes that pass through each other, some twice at one place, and spheres.
struct PartsScene {
  explicit PartsScene(std::uint64_t seed, int count, bool with_materials) {
    Random random(seed);
    for (int i = 0; i < count; ++i) {
      Instance instance;
      if (i > 0 && random.chance(0.3)) {
        instance = scene.instances[static_cast<std::size_t>(random.integer(0, i - 1))];
      } else if (random.chance(0.25)) {
        instance.geometry = static_cast<std::uint32_t>(scene.geometries.size());
        Spheres spheres;
        for (int k = 0; k < 5; ++k) spheres.centers.push_back(random_point(random, 0.1F));
        spheres.radius = 0.2F;
        scene.geometries.emplace_back(std::move(spheres));
      } else {
        instance.mesh = static_cast<std::uint32_t>(scene.meshes.size());
        scene.meshes.push_back(shapes::soup(40, 0.1F, 0.8F, random.bits()));
        const double angle = random.real(0, 3);
        instance.object_to_world = rotation(rotation_about({0.3, 1, 0.2}, angle));
      }
      if (!with_materials && random.chance(0.5)) instance.color = Vec4{0.9F, 0.3F, 0.1F, 1};
      if (with_materials) instance.material = static_cast<std::uint32_t>(random.integer(0, 1));
      scene.instances.push_back(instance);
    }
    if (with_materials) {
      scene.materials.resize(2);
      scene.materials[1].base_color = {0.2F, 0.5F, 0.9F, 1};
      scene.materials[1].metallic = 0.3F;
      scene.materials[1].double_sided = true;
    }
  }
  Scene scene;
};

/// The parts that each rank holds, by their numbers.
using Deal = std::vector<std::vector<std::uint64_t>>;

/// Another communicator, as if each rank were a process.
class AsProcesses : public Communicator {
 public:
  explicit AsProcesses(Communicator& ranks) : ranks_(ranks) {}
  [[nodiscard]] int rank() const override { return ranks_.rank(); }
  [[nodiscard]] int size() const override { return ranks_.size(); }
  [[nodiscard]] std::uint64_t max(std::uint64_t value) override { return ranks_.max(value); }
  void max_of_each(std::span<std::uint64_t> values) override { ranks_.max_of_each(values); }
  void broadcast(std::span<std::byte> bytes, int root) override { ranks_.broadcast(bytes, root); }
  void exchange_sizes(std::span<const std::uint64_t> to, std::span<std::uint64_t> from) override {
    ranks_.exchange_sizes(to, from);
  }
  void exchange(std::span<const std::span<const std::byte>> to,
                std::span<const std::span<std::byte>> from) override {
    ranks_.exchange(to, from);
  }
  [[nodiscard]] std::span<std::uint64_t> share(std::size_t words) override {
    return ranks_.share(words);
  }

 private:
  Communicator& ranks_;
};

/// A scene with some of the instances.
class SomeParts {
 public:
  SomeParts(const SceneView& all, std::span<const std::uint64_t> parts) : view_(all) {
    for (const std::uint64_t p : parts) instances_.push_back(all.instances[p]);
    view_.instances = instances_;
  }
  SomeParts(const SomeParts&) = delete;
  SomeParts& operator=(const SomeParts&) = delete;
  [[nodiscard]] const SceneView& view() const { return view_; }

 private:
  std::vector<InstanceView> instances_;
  SceneView view_;
};

inline constexpr RendererOptions kSerialRank{.device = Device::serial}, kThreadRank{.threads = 1};

/// A scene for ranks, its view, and one renderer's picture of it.
class Whole {
 public:
  Whole(Scene drawn, const FrameOptions& options, const std::optional<Camera>& from = {},
        bool prepared = false)
      : scene(std::move(drawn)),
        frame(options),
        camera(from ? *from : fit_camera(binding.view(), 1.0472F, false)) {
    if (prepared) binding.prepare();
  }
  Whole(const Whole&) = delete;
  Whole& operator=(const Whole&) = delete;

  [[nodiscard]] SceneView view() const { return binding.view(); }
  [[nodiscard]] bool is_linear() const {
    return shader_for(frame.shader, view()) == Shader::material;
  }
  [[nodiscard]] AllTargets images() const { return {frame.width, frame.height, is_linear()}; }
  /// The renderer's picture, drawn on first use.
  [[nodiscard]] const Targets& one() const {
    if (!one_) {
      one_.emplace(frame.width, frame.height, is_linear());
      stats_ = Renderer({.threads = 2}).render(view(), camera, frame, one_->targets());
    }
    return one_->targets();
  }
  [[nodiscard]] const FrameStats& stats() const {
    (void)one();
    return stats_;
  }

  /// Draws this rank's `parts` into the root's targets.
  RanksStats draw_on(Communicator& c, std::span<const std::uint64_t> parts, const Targets& targets,
                     const RanksOptions& options = {}, const RendererOptions& of_rank = kSerialRank,
                     const ranks::AtPhase& at = {}) const {
    const SomeParts held(view(), parts);
    Renderer renderer(of_rank);
    return ranks::render_parts(c, renderer, held.view(), parts, camera, frame,
                               c.rank() == options.root ? targets : Targets{}, options, at);
  }
  /// Draws by `ranks` into the root's targets. Returns the root's statistics.
  RanksStats draw(LocalRanks& ranks, const Deal& deal, const Targets& targets,
                  const RanksOptions& options = {}, const RendererOptions& of_rank = kSerialRank,
                  const ranks::AtPhase& at = {}, bool as_processes = false) const {
    RanksStats of_root;
    ranks.run([&](Communicator& threads) {
      AsProcesses processes(threads);
      Communicator& c = as_processes ? processes : threads;
      const RanksStats stats =
          draw_on(c, deal[static_cast<std::size_t>(c.rank())], targets, options, of_rank, at);
      if (c.rank() == options.root) of_root = stats;
    });
    return of_root;
  }
  /// The same; expects the renderer's picture in all targets.
  RanksStats expect(LocalRanks& ranks, const Deal& deal, const RanksOptions& options = {},
                    const RendererOptions& of_rank = kSerialRank, const ranks::AtPhase& at = {},
                    bool as_processes = false) const {
    const AllTargets many = images();
    const RanksStats stats = draw(ranks, deal, many.targets(), options, of_rank, at, as_processes);
    EXPECT_TRUE(same_targets(one(), many.targets()));
    return stats;
  }

  Scene scene;
  SceneBinding binding{scene};
  FrameOptions frame;
  Camera camera;

 private:
  mutable std::optional<AllTargets> one_;
  mutable FrameStats stats_;
};

}  // namespace rastrum::test
