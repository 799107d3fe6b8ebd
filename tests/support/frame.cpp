// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/frame.hpp"
#include "tests/support/painter.hpp"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <numeric>
#include <span>
#include <type_traits>

namespace rastrum::test {
namespace {

using testing::AssertionFailure;
using testing::AssertionResult;
using testing::AssertionSuccess;

/// Calls f for the numbers of a pixel of any type.
template <class T, class F>
void for_each_number(const T& pixel, const F& f) {
  if constexpr (std::is_same_v<T, Rgba8>) {
    for (const int v : {pixel.r, pixel.g, pixel.b, pixel.a}) f(v);
  } else if constexpr (std::is_arithmetic_v<T>) {
    f(pixel);
  } else {
    float v[sizeof(T) / sizeof(float)];
    std::memcpy(v, &pixel, sizeof v);
    for (const float x : v) f(x);
  }
}

template <class T, class Same>
AssertionResult same_pixels(const char* what, int width, std::span<const T> a, std::span<const T> b,
                            const Same& same) {
  if (a.size() != b.size()) return AssertionFailure() << what << ": sizes differ";
  std::size_t differing = 0, first = 0;
  for (std::size_t i = a.size(); i-- > 0;) {
    if (same(a[i], b[i])) continue;
    ++differing;
    first = i;
  }
  if (differing == 0) return AssertionSuccess();
  const auto w = static_cast<std::size_t>(width);
  AssertionResult failure = AssertionFailure();
  failure << what << ": " << differing << " pixels differ, first at (" << first % w << ", "
          << first / w << "):";
  for_each_number(a[first], [&](auto v) { failure << ' ' << v; });
  failure << " and";
  for_each_number(b[first], [&](auto v) { failure << ' ' << v; });
  return failure;
}

}  // namespace

Frame::Frame(int width, int height, unsigned kinds) {
  for_each_kind([&](unsigned kind, const char*, auto member, auto) {
    if ((kinds & kind) == 0) return;
    auto& image = this->*member;
    image = std::remove_reference_t<decltype(image)>(width, height);
    std::memset(static_cast<void*>(image.pixels().data()), 0x5A, image.pixels().size_bytes());
  });
}

Targets Frame::targets() {
  Targets targets;
  for_each_kind(
      [&](unsigned, const char*, auto member, auto target) { targets.*target = this->*member; });
  return targets;
}

Frame draw(Renderer& renderer, const SceneView& scene, const Camera& camera,
           const FrameOptions& frame, unsigned kinds) {
  Frame f(frame.width, frame.height, kinds);
  f.stats = renderer.render(scene, camera, frame, f.targets());
  return f;
}

Frame draw(Painter& renderer, const SceneView& scene, const Camera& camera, unsigned kinds) {
  Frame f(renderer.options().width, renderer.options().height, kinds);
  f.stats = renderer.render(scene, camera, f.targets());
  return f;
}

Frame draw(Painter& renderer, std::span<raster::Draw> draws, const raster::Shading& shader,
           const raster::Testing& test) {
  Frame f(renderer.options().width, renderer.options().height, kCounted);
  f.stats = renderer.draw(draws, shader, test, f.targets());
  return f;
}

Frame draw(const RendererOptions& by, const SceneView& scene, const Camera& camera,
           const FrameOptions& frame, unsigned kinds) {
  Renderer renderer(by);
  return draw(renderer, scene, camera, frame, kinds);
}

Frame draw(const RenderOptions& options, const SceneView& scene, const Camera& camera,
           unsigned kinds) {
  Painter painter(options);
  return draw(painter, scene, camera, kinds);
}

Frame draw(const RenderOptions& options, const Scene& scene, const Camera& camera) {
  return draw(options, SceneBinding(scene).view(), camera);
}

AssertionResult same_images(const Frame& a, const Frame& b, unsigned kinds) {
  AssertionResult result = AssertionSuccess();
  for_each_kind([&](unsigned kind, const char* name, auto member, auto) {
    if (!result || (kinds & kind) == 0) return;
    const auto &x = a.*member, &y = b.*member;
    result = same_pixels(name, x.width(), x.pixels(), y.pixels(),
                         [](const auto& p, const auto& q) { return same_pixel(p, q); });
  });
  return result;
}

AssertionResult same_frames(const Frame& a, const Frame& b) {
  AssertionResult images = same_images(a, b);
  return images ? same_counts(a.stats, b.stats) : images;
}

AssertionResult same_surfaces(const Frame& a, const Frame& b) {
  return same_images(a, b, kIds | kDepth | kOverdraw);
}

AssertionResult same_surfaces(const Frame& a, const OracleImage& b) {
  const int w = a.ids.width();
  const auto same = [](const auto& p, const auto& q) { return same_pixel(p, q); };
  if (auto r = same_pixels<std::uint32_t>("overdraw", w, a.overdraw.pixels(), b.overdraw, same); !r)
    return r;
  if (auto r = same_pixels<float>("depth", w, a.depth.pixels(), b.depth, same); !r) return r;
  return same_pixels<std::int64_t>("ids", w, a.ids.pixels(), b.ids, same);
}

AssertionResult same_picture(const Frame& a, const Frame& b, int tolerance) {
  if (tolerance == 0) return same_images(a, b, kColor8 | kColor);
  return same_pixels("colour", a.color8.width(), a.color8.pixels(), b.color8.pixels(),
                     [tolerance](Rgba8 x, Rgba8 y) {
                       return std::abs(x.r - y.r) <= tolerance &&
                              std::abs(x.g - y.g) <= tolerance &&
                              std::abs(x.b - y.b) <= tolerance && std::abs(x.a - y.a) <= tolerance;
                     });
}

AssertionResult same_triangles(const FrameStats& a, const FrameStats& b) {
  FrameStats as_many = a;
  as_many.fragments = b.fragments;
  return same_counts(as_many, b);
}

AssertionResult same_counts(const FrameStats& a, const FrameStats& b) {
  const auto text = [](const FrameStats& s) {
    const FrameStats::Triangles& t = s.triangles;
    return (testing::Message() << "input " << t.input << " dropped " << t.dropped << " culled "
                               << t.culled << " clipped " << t.clipped << " drawn " << t.drawn
                               << " fragments " << s.fragments << " pixels " << s.pixels_covered)
        .GetString();
  };
  if (text(a) == text(b)) return AssertionSuccess();
  return AssertionFailure() << text(a) << " and " << text(b);
}

AssertionResult counts_add_up(const Frame& f) {
  const FrameStats::Triangles& t = f.stats.triangles;
  if (t.input != t.dropped + t.culled + t.drawn)
    return AssertionFailure() << t.input << " triangles are not " << t.dropped << " dropped + "
                              << t.culled << " culled + " << t.drawn << " drawn";
  if (t.clipped > t.drawn)
    return AssertionFailure() << t.clipped << " clipped, but only " << t.drawn << " drawn";
  const auto over = f.overdraw.pixels();
  const std::uint64_t fragments = std::accumulate(over.begin(), over.end(), std::uint64_t{0});
  if (f.stats.fragments != fragments)
    return AssertionFailure() << f.stats.fragments << " fragments, the overdraw's sum is "
                              << fragments;
  const auto covered = static_cast<std::uint64_t>(
      std::ranges::count_if(over, [](std::uint32_t n) { return n > 0; }));
  if (f.stats.pixels_covered != covered)
    return AssertionFailure() << f.stats.pixels_covered << " pixels covered, the overdraw has "
                              << covered;
  return AssertionSuccess();
}

std::uint64_t counter(const FrameStats& stats, std::string_view name) {
  for (const auto& [key, value] : stats.counters)
    if (key == name) return value;
  ADD_FAILURE() << "no counter is called " << name;
  return 0;
}

}  // namespace rastrum::test
