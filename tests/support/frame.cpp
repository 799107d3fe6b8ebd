#include "tests/support/frame.hpp"
#include "tests/support/painter.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numeric>
#include <span>

namespace rastrum::test {
namespace {

using testing::AssertionFailure;
using testing::AssertionResult;
using testing::AssertionSuccess;

std::uint32_t bits(float v) {
  return std::bit_cast<std::uint32_t>(v);
}

template <class A, class B, class Same, class Show>
AssertionResult same_pixels(const char* what, int width, std::span<const A> a, std::span<const B> b,
                            Same same, Show show) {
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
          << first / w << "): ";
  show(failure, a[first]);
  failure << " and ";
  show(failure, b[first]);
  return failure;
}

AssertionResult same_surfaces(int width, std::span<const std::int64_t> ids_a,
                              std::span<const std::int64_t> ids_b, std::span<const float> depth_a,
                              std::span<const float> depth_b, std::span<const std::uint32_t> over_a,
                              std::span<const std::uint32_t> over_b) {
  const auto equal = [](auto x, auto y) { return x == y; };
  const auto plain = [](AssertionResult& r, auto v) { r << v; };
  if (auto r = same_pixels("overdraw", width, over_a, over_b, equal, plain); !r) return r;
  if (auto r = same_pixels(
          "depth", width, depth_a, depth_b, [](float x, float y) { return bits(x) == bits(y); },
          [](AssertionResult& out, float v) { out << v << " (0x" << std::hex << bits(v) << ")"; });
      !r)
    return r;
  return same_pixels("ids", width, ids_a, ids_b, equal, plain);
}

}  // namespace

namespace {

/// Calls render(targets) with images that hold nonsense.
template <class Render>
Frame draw_with(Painter& renderer, Render&& render) {
  const int w = renderer.options().width, h = renderer.options().height;
  Frame f{Image<Rgba8>(w, h),        Image<Vec4>(w, h),          Image<float>(w, h),
          Image<std::int64_t>(w, h), Image<std::uint32_t>(w, h), {}};
  std::ranges::fill(f.color8.pixels(), Rgba8{1, 2, 3, 4});
  std::ranges::fill(f.color.pixels(), Vec4{-7, -7, -7, -7});
  std::ranges::fill(f.depth.pixels(), std::numeric_limits<float>::quiet_NaN());
  std::ranges::fill(f.ids.pixels(), -777);
  std::ranges::fill(f.overdraw.pixels(), 777777U);
  Targets targets;
  targets.color8 = f.color8.view();
  targets.color = f.color.view();
  targets.depth = f.depth.view();
  targets.ids = f.ids.view();
  targets.overdraw = f.overdraw.view();
  f.stats = render(targets);
  return f;
}

}  // namespace

Frame draw(Painter& renderer, const SceneView& scene, const Camera& camera) {
  return draw_with(renderer,
                   [&](const Targets& targets) { return renderer.render(scene, camera, targets); });
}

Frame draw(Painter& renderer, std::span<raster::Draw> draws, const raster::BlockShader& shader,
           const raster::FragmentTest* test) {
  return draw_with(renderer, [&](const Targets& targets) {
    return renderer.draw(draws, shader, test, targets);
  });
}

Frame draw(const RenderOptions& options, const Scene& scene, const Camera& camera) {
  Painter renderer(options);
  return draw(renderer, SceneBinding(scene).view(), camera);
}

AssertionResult same_surfaces(const Frame& a, const Frame& b) {
  return same_surfaces(a.ids.width(), a.ids.pixels(), b.ids.pixels(), a.depth.pixels(),
                       b.depth.pixels(), a.overdraw.pixels(), b.overdraw.pixels());
}

AssertionResult same_surfaces(const Frame& a, const OracleImage& b) {
  return same_surfaces(a.ids.width(), a.ids.pixels(), b.ids, a.depth.pixels(), b.depth,
                       a.overdraw.pixels(), b.overdraw);
}

AssertionResult same_picture(const Frame& a, const Frame& b, int tolerance) {
  const auto near = [tolerance](Rgba8 x, Rgba8 y) {
    return std::abs(x.r - y.r) <= tolerance && std::abs(x.g - y.g) <= tolerance &&
           std::abs(x.b - y.b) <= tolerance && std::abs(x.a - y.a) <= tolerance;
  };
  if (tolerance == 0 && !a.color.empty() && !b.color.empty()) {
    // A NaN is one everywhere; its sign and payload are the processor's (docs/conventions.md).
    const auto same_float = [](float x, float y) {
      return std::bit_cast<std::uint32_t>(x) == std::bit_cast<std::uint32_t>(y) ||
             (x != x && y != y);
    };
    const auto same = [same_float](const Vec4& x, const Vec4& y) {
      return same_float(x.x, y.x) && same_float(x.y, y.y) && same_float(x.z, y.z) &&
             same_float(x.w, y.w);
    };
    auto floats = same_pixels("float colour", a.color.width(), a.color.pixels(), b.color.pixels(),
                              same, [](AssertionResult& r, const Vec4& v) {
                                r << '(' << v.x << ' ' << v.y << ' ' << v.z << ' ' << v.w << ')';
                              });
    if (!floats) return floats;
  }
  return same_pixels("colour", a.color8.width(), a.color8.pixels(), b.color8.pixels(), near,
                     [](AssertionResult& r, Rgba8 v) {
                       r << '(' << int{v.r} << ' ' << int{v.g} << ' ' << int{v.b} << ' ' << int{v.a}
                         << ')';
                     });
}

AssertionResult same_counts(const FrameStats& a, const FrameStats& b) {
  const auto show = [](AssertionResult& r, const FrameStats& s) {
    r << "input " << s.triangles.input << " dropped " << s.triangles.dropped << " culled "
      << s.triangles.culled << " clipped " << s.triangles.clipped << " drawn " << s.triangles.drawn
      << " fragments " << s.fragments << " pixels " << s.pixels_covered;
  };
  if (a.triangles.input == b.triangles.input && a.triangles.dropped == b.triangles.dropped &&
      a.triangles.culled == b.triangles.culled && a.triangles.clipped == b.triangles.clipped &&
      a.triangles.drawn == b.triangles.drawn && a.fragments == b.fragments &&
      a.pixels_covered == b.pixels_covered)
    return AssertionSuccess();
  AssertionResult failure = AssertionFailure();
  show(failure, a);
  failure << " and ";
  show(failure, b);
  return failure;
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
