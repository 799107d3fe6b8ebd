// SPDX-License-Identifier: BSD-3-Clause
// Edges over the picture of ranks have the bits of one renderer's.
#include <string>

#include <gtest/gtest.h>

#include <rastrum/annotate.hpp>

#include "tests/ranks/deals.hpp"
#include "tests/support/refused.hpp"

namespace rastrum::test {
namespace {

Frame colors_of(const FrameOptions& o) {
  return {o.width, o.height, kColor8 | kColor};
}

class EdgesOfParts : public testing::Test {
 protected:
  PartsScene parts_{11, kParts, false};
  EdgesOfParts() {
    for (std::size_t p = 0; p < kParts; p += 3) parts_.scene.instances[p].opacity = 0.5F;
  }

  void draw(LocalRanks& ranks, const Deal& deal, const SceneView& all, const Camera& camera,
            const FrameOptions& frame, const Annotations& notes, const Targets& targets) {
    ranks.run([&](Communicator& c) {
      const auto& parts = deal[static_cast<std::size_t>(c.rank())];
      const SomeParts held(all, parts);
      Renderer renderer({.threads = 1});
      Annotator annotator(1);
      (void)render_parts(c, renderer, annotator, held.view(), parts, camera, frame, notes,
                         c.rank() == 0 ? targets : Targets{}, {});
    });
  }
};

TEST_F(EdgesOfParts, EqualOneRenderersWhoeverHoldsThem) {
  const SceneBinding binding(parts_.scene);
  const Camera camera = fit_camera(binding.view(), 1.0472F, false);
  for (const int samples : {1, 4}) {
    FrameOptions frame = frame_of(Shader::phong, 130, 90);
    frame.samples = samples;
    for (const EdgeLines lines : {EdgeLines{}, EdgeLines{30, 2.5}}) {
      Annotations notes;
      Frame plain = colors_of(frame), one = plain;
      Renderer renderer({.threads = 2});
      Annotator annotator(2);
      (void)renderer.render(binding.view(), camera, frame, plain.targets());
      notes.edges = lines;
      (void)annotator.render(renderer, binding.view(), camera, frame, notes, one.targets());
      ASSERT_FALSE(same_images(plain, one)) << "no edge is seen";
      for (const int n : {1, 2, 5}) {
        LocalRanks ranks(n);
        Random random(static_cast<std::uint64_t>(n));
        for (const Deal& deal : {contiguous(n), round_robin(n), random_deal(n, random)}) {
          Frame many = colors_of(frame);
          draw(ranks, deal, binding.view(), camera, frame, notes, many.targets());
          EXPECT_TRUE(same_images(one, many))
              << n << " ranks, " << samples << " samples, " << lines.angle_degrees << " degrees";
        }
      }
    }
  }
}

TEST_F(EdgesOfParts, AWidthOutOfRangeIsSaidByAll) {
  const SceneBinding binding(parts_.scene);
  const FrameOptions frame = frame_of(Shader::phong, 40, 30);
  Annotations notes{.edges = EdgeLines{0, 65}};
  for (const int n : {1, 3}) {
    LocalRanks ranks(n);
    Frame many = colors_of(frame);
    const std::string said = refusal_of([&] {
      draw(ranks, contiguous(n), binding.view(), fit_camera(binding.view(), 1, false), frame, notes,
           many.targets());
    });
    EXPECT_TRUE(holds(said, "the width of edges must lie in (0, 64] px"));
    EXPECT_TRUE(said.starts_with("rank ")) << said;
  }
}

}  // namespace
}  // namespace rastrum::test
