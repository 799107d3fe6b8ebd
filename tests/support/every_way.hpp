// SPDX-License-Identifier: BSD-3-Clause
// Every way to draw a picture gives the same bits: the serial reference, threads of any number on
// each instruction set, a device.
#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/parallel/cuda/status.hpp>
#include <rastrum/render.hpp>

#include "tests/support/frame.hpp"

namespace rastrum::test {

[[nodiscard]] inline std::string name_of(const RendererOptions& o) {
  return std::string(name(o.device)) + ", " + std::to_string(o.threads) + " threads, " +
         std::string(o.isa ? name(*o.isa) : "any instruction set") + ", " +
         std::to_string(o.memory_limit) + " bytes";
}

class EveryWay {
 public:
  /// `base` by the serial reference, by each of `hows` (on each instruction set, where it names
  /// none) and, where one is usable, by a device.
  explicit EveryWay(const RenderOptions& base,
                    std::initializer_list<RendererOptions> hows = {{.threads = 1},
                                                                   {.threads = 2},
                                                                   {.threads = 8}})
      : base_(base) {
    add({.device = Device::serial, .threads = 1, .isa = Isa::scalar});
    for (RendererOptions how : hows)
      for (const Isa isa : how.isa ? std::vector{*how.isa} : available_isas()) {
        how.isa = isa;
        add(how);
      }
    if (parallel::cuda_status().usable) add({.device = Device::cuda});
  }
  EveryWay(std::initializer_list<RendererOptions> hows = {{.threads = 1}, {.threads = 3}})
      : EveryWay(RenderOptions{}, hows) {}

  [[nodiscard]] auto begin() const { return ways_.begin(); }
  [[nodiscard]] auto end() const { return ways_.end(); }

  /// Calls draw(options), draw(renderer) or draw(painter) for the serial reference and gives its
  /// result; expects that all other ways give the same, says which does not, and ends with it. A
  /// way keeps its renderer from call to call.
  template <class Draw>
  auto same(const Draw& draw) {
    return same(draw, [](const auto&, const auto&) {});
  }
  /// Calls also(result, expected), too.
  template <class Draw, class Also>
  auto same(const Draw& draw, const Also& also) {
    const auto by = [&](std::size_t i) {
      if constexpr (std::is_invocable_v<Draw, Painter&>) {
        return draw(kept(painters_, i));
      } else if constexpr (std::is_invocable_v<Draw, Renderer&>) {
        return draw(kept(renderers_, i));
      } else {
        return draw(ways_[i]);
      }
    };
    auto expected = by(0);
    for (std::size_t i = 1; i < ways_.size() && !testing::Test::HasFailure(); ++i) {
      SCOPED_TRACE(name_of(ways_[i]));
      const auto got = by(i);
      if constexpr (std::is_same_v<decltype(expected), Frame>)
        EXPECT_TRUE(same_images(got, expected));
      else
        EXPECT_EQ(got, expected);
      also(got, expected);
    }
    return expected;
  }

 private:
  void add(const RendererOptions& how) {
    RenderOptions& way = ways_.emplace_back(base_);
    static_cast<RendererOptions&>(way) = how;
    if (how.memory_limit == 0) way.memory_limit = base_.memory_limit;
  }
  template <class T>
  T& kept(std::vector<std::optional<T>>& all, std::size_t i) {
    all.resize(ways_.size());
    if (!all[i]) all[i].emplace(ways_[i]);
    return *all[i];
  }

  RenderOptions base_;
  std::vector<RenderOptions> ways_;
  std::vector<std::optional<Renderer>> renderers_;
  std::vector<std::optional<Painter>> painters_;
};

}  // namespace rastrum::test
