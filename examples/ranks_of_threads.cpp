// SPDX-License-Identifier: BSD-3-Clause
// Draws one picture of parts on several ranks, here threads of one process, each with its own arms
// of a galaxy. The picture has the same bits for any number of ranks.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <random>
#include <vector>

#include <rastrum/digest.hpp>
#include <rastrum/io.hpp>
#include <rastrum/ranks.hpp>

using rastrum::Vec3, rastrum::Vec4;

std::vector<Vec3> stars_of(std::uint64_t arm) {
  std::mt19937 random(static_cast<unsigned>(arm));
  const auto off = [&](double most) { return most * (static_cast<double>(random()) / 0x1p31 - 1); };
  std::vector<Vec3> stars;
  for (int i = 0; i < 4000; ++i) {
    const double t = i / 4000.0, angle = 5 * t + 1.5707963 * static_cast<double>(arm);
    const double x = (0.1 + 3 * t) * std::cos(angle), z = (0.1 + 3 * t) * std::sin(angle);
    stars.push_back(Vec3(rastrum::Vec3d{x + off(0.1 + 0.4 * t), off(0.2), z + off(0.1 + 0.4 * t)}));
  }
  return stars;
}

int main() {
  constexpr std::uint64_t kArms = 4;
  constexpr Vec4 kColors[kArms] = {
      {0.5F, 0.7F, 1, 1}, {1, 0.8F, 0.5F, 1}, {1, 0.6F, 0.7F, 1}, {0.7F, 1, 0.8F, 1}};
  const rastrum::Camera camera{.eye = {0, 3.4, 4}, .target = {0, 0, 0.3}};
  const rastrum::FrameOptions frame{
      .width = 640, .height = 360, .background = {0, 0, 0.05F, 1}, .opacity = 0.6F, .samples = 4};
  rastrum::Image<rastrum::Rgba8> picture(frame.width, frame.height);

  const auto draw = [&](rastrum::Communicator& ranks) {
    const auto rank = static_cast<std::uint64_t>(ranks.rank());
    std::vector<std::uint64_t> parts;  // numbers of this rank's arms among all arms
    std::vector<std::vector<Vec3>> stars;
    std::vector<rastrum::SpheresView> views;
    std::vector<rastrum::InstanceView> instances;
    for (std::uint64_t a = rank; a < kArms; a += static_cast<std::uint64_t>(ranks.size())) {
      parts.push_back(a);
      stars.push_back(stars_of(a));
    }
    for (const auto& centers : stars) views.push_back({.centers = centers, .radius = 0.025F});
    for (std::size_t i = 0; i < views.size(); ++i)
      instances.push_back({.geometry = views[i], .color = kColors[parts[i]]});
    rastrum::Renderer renderer({.threads = 1});
    // Rank 0, the root, gets the picture; targets of others are not used.
    rastrum::render_parts(ranks, renderer, {.instances = instances}, parts, camera, frame,
                          {.color8 = picture});
  };
  for (const int ranks : {1, 2, 4}) {
    rastrum::LocalRanks(ranks).run(draw);
    std::printf("%d: %s\n", ranks, rastrum::digest(picture).hex().c_str());
  }
  rastrum::io::write_png("ranks_of_threads.png", picture);
}
