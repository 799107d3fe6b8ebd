// SPDX-License-Identifier: BSD-3-Clause
#include "stand_ins.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <unordered_map>
#include <utility>

#include <rastrum/error.hpp>
#include <rastrum/render.hpp>
#include <rastrum/scene.hpp>
#include <rastrum/shapes.hpp>

#include "contest.hpp"
#include "scenes.hpp"

namespace rastrum::bench {
namespace {

constexpr float kWave = 0.06F;      ///< of the ball's radius
constexpr float kShellGap = 0.04F;  ///< between nested balls, so that their waves do not meet

/// Splits triangles, evenly spaced over the list, at their centroids. Each split adds 2.
void add_pairs(Mesh& mesh, std::size_t pairs) {
  const std::size_t n = mesh.indices.size() / 3;
  if (pairs == 0) return;
  if (pairs > n) throw Error(Errc::invalid_argument, "too few triangles to split");
  std::vector<std::uint32_t> out;
  out.reserve(mesh.indices.size() + pairs * 6);
  for (std::size_t t = 0; t < n; ++t) {
    const std::uint32_t a = mesh.indices[3 * t], b = mesh.indices[3 * t + 1],
                        c = mesh.indices[3 * t + 2];
    // Exactly `pairs` of the n steps cross a multiple of n.
    if ((t + 1) * pairs / n == t * pairs / n) {
      out.insert(out.end(), {a, b, c});
      continue;
    }
    const auto m = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.push_back((mesh.positions[a] + mesh.positions[b] + mesh.positions[c]) *
                             (1.0F / 3));
    out.insert(out.end(), {a, b, m, b, c, m, c, a, m});
  }
  mesh.indices = std::move(out);
}

/// Adds triangles until there are exactly `triangles`.
void fill_up(Mesh& mesh, std::size_t triangles) {
  const std::size_t n = mesh.indices.size() / 3;
  const std::size_t missing = triangles - n;
  add_pairs(mesh, (missing + 1) / 2);
  mesh.indices.resize(triangles * 3);
}

Mesh one_ball(std::size_t triangles, float stretch, float radius) {
  // A ball has 2 (rings − 1) segments triangles. Takes the near-square pair that comes closest from
  // below.
  const double middle = std::sqrt(static_cast<double>(triangles) / 4);
  std::size_t rings = 2, segments = 3, best = 0;
  const auto first = static_cast<std::size_t>(std::max(2.0, middle * 0.8));
  for (std::size_t r = first; r <= static_cast<std::size_t>(middle * 1.2) + 2; ++r) {
    const std::size_t s = triangles / (2 * (r - 1));
    if (s < 3 || 2 * (r - 1) * s <= best) continue;
    rings = r;
    segments = s;
    best = 2 * (r - 1) * s;
  }
  Mesh mesh = shapes::sphere(static_cast<int>(rings), static_cast<int>(segments));
  mesh.normals = {};
  mesh.texcoords = {};
  for (Vec3& p : mesh.positions) {
    const float wave = std::sin(5 * std::atan2(p.z, p.x)) * (1 - p.y * p.y) * std::cos(7 * p.y);
    p = p * (radius * (1 + kWave * wave));
    p.x *= stretch;
  }
  fill_up(mesh, triangles);
  return mesh;
}

void append(Mesh& mesh, const Mesh& more) {
  const auto base = static_cast<std::uint32_t>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), more.positions.begin(), more.positions.end());
  for (const std::uint32_t i : more.indices) mesh.indices.push_back(base + i);
}

/// Merges the vertices of each cell into its first one and drops triangles without area. `cells` is
/// the number along the longest side.
Mesh clustered(const Mesh& mesh, double cells) {
  const MeshView view = mesh.view();
  const InstanceView instance{view};
  const Bounds box = bounds({.instances = {&instance, 1}});
  const Vec3 corner(box.min), size = Vec3(box.max) - corner;
  const double scale = cells / static_cast<double>(std::max({size.x, size.y, size.z, 1e-30F}));
  std::unordered_map<std::uint64_t, std::uint32_t> first;
  Mesh out;
  std::vector<std::uint32_t> moved(mesh.positions.size());
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const auto axis = [&](float v, float low) {
      return static_cast<std::uint64_t>(std::max(0.0, static_cast<double>(v - low) * scale)) &
             0x1FFFFFU;
    };
    const Vec3 p = mesh.positions[i];
    const std::uint64_t cell =
        axis(p.x, corner.x) << 42 | axis(p.y, corner.y) << 21 | axis(p.z, corner.z);
    const auto [found, is_new] =
        first.try_emplace(cell, static_cast<std::uint32_t>(out.positions.size()));
    if (is_new) out.positions.push_back(p);
    moved[i] = found->second;
  }
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const std::array<std::uint32_t, 3> v{moved[mesh.indices[i]], moved[mesh.indices[i + 1]],
                                         moved[mesh.indices[i + 2]]};
    if (v[0] != v[1] && v[1] != v[2] && v[2] != v[0])
      out.indices.insert(out.indices.end(), v.begin(), v.end());
  }
  return out;
}

/// Numbers in [0, 1), the same on every machine, unlike <random>'s distributions.
class Numbers {
 public:
  explicit Numbers(std::uint64_t seed) : bits_(seed) {}
  double unit() { return static_cast<double>(bits_() >> 11) * 0x1p-53; }
  std::size_t below(std::size_t n) { return static_cast<std::size_t>(bits_() % n); }

 private:
  std::mt19937_64 bits_;
};

}  // namespace

Mesh ball(std::size_t triangles, float stretch, int shells) {
  const auto n = static_cast<std::size_t>(shells);
  if (shells < 1 || triangles / n < 8)
    throw Error(Errc::invalid_argument, "a ball has at least 8 triangles a shell");
  Mesh mesh;
  for (std::size_t k = 0; k < n; ++k) {
    // The shares add up to `triangles`.
    const std::size_t share = triangles * (k + 1) / n - triangles * k / n;
    append(mesh, one_ball(share, stretch, 1 - kShellGap * static_cast<float>(k)));
  }
  return mesh;
}

Mesh with_triangles(Mesh mesh, std::size_t triangles) {
  if (mesh.indices.empty())
    for (std::size_t i = 0; i < mesh.positions.size() / 3 * 3; ++i)
      mesh.indices.push_back(static_cast<std::uint32_t>(i));
  mesh.normals = {};
  mesh.texcoords = {};
  mesh.colors = {};
  mesh.face_materials.clear();
  if (mesh.indices.empty()) throw Error(Errc::invalid_argument, "the mesh has no triangles");
  while (mesh.triangle_count() < triangles) mesh = shapes::subdivide(mesh, 1);
  if (mesh.triangle_count() == triangles) return mesh;
  double low = 1, high = 1 << 20;
  for (int i = 0; i < 40; ++i) {
    const double middle = std::sqrt(low * high);
    (clustered(mesh, middle).triangle_count() <= triangles ? low : high) = middle;
  }
  Mesh best = clustered(mesh, low);
  if (best.triangle_count() * 3 < triangles)
    throw Error(Errc::invalid_argument, "the mesh cannot be decimated to so few triangles");
  fill_up(best, triangles);
  return best;
}

MeshView first_part(const Mesh& mesh, double share) {
  MeshView view = mesh.view();
  const auto n = static_cast<std::size_t>(static_cast<double>(mesh.triangle_count()) * share);
  view.indices = view.indices.subview(0, n * 3);
  return view;
}

Mesh subdivided_part(const Mesh& mesh, int times, std::size_t k, std::size_t n) {
  const std::size_t triangles = mesh.triangle_count();
  const std::size_t first = triangles * k / n, last = triangles * (k + 1) / n;
  Mesh part;
  // Numbers vertices in the order of their first use.
  constexpr std::uint32_t kUnseen = ~std::uint32_t{0};
  std::vector<std::uint32_t> numbers(mesh.positions.size(), kUnseen);
  for (std::size_t i = first * 3; i < last * 3; ++i) {
    const std::uint32_t v = mesh.indices.empty() ? static_cast<std::uint32_t>(i) : mesh.indices[i];
    if (numbers[v] == kUnseen) {
      numbers[v] = static_cast<std::uint32_t>(part.positions.size());
      part.positions.push_back(mesh.positions[v]);
    }
    part.indices.push_back(numbers[v]);
  }
  return shapes::subdivide(part, times);
}

Camera whole_view(const Mesh& mesh) {
  const MeshView view = mesh.view();
  const InstanceView instance{view};
  return fit_camera({.instances = {&instance, 1}}, Camera{}.fov_rad, false);
}

FragmentMatch match_fragments(const Mesh& mesh, int width, int height, std::uint64_t fragments,
                              int threads) {
  const Camera fitted = whole_view(mesh);
  // Hidden fragments count too.
  Renderer renderer = family::make_renderer({.threads = threads}, {.hierarchical_z = false});
  Image<float> depth(width, height);
  const Vec3 target(fitted.target), back = Vec3(fitted.eye) - target;
  const auto look = [&](double distance) {
    FragmentMatch match{fitted, 0};
    match.camera.eye = target + back * static_cast<float>(distance);
    match.camera.near_plane = length(back) * 1e-3F;
    match.found =
        draw(renderer, {mesh.view(), match.camera, width, height}, {}, {.depth = depth}).fragments;
    return match;
  };
  // Below 0.6 the eye would be inside of a ball.
  double low = 0.6, high = 64;
  FragmentMatch best = look(1);
  const auto error = [&](const FragmentMatch& m) {
    return std::abs(static_cast<double>(m.found) / static_cast<double>(fragments) - 1);
  };
  for (int i = 0; i < 24 && error(best) > 0.002; ++i) {
    const double middle = std::sqrt(low * high);
    const FragmentMatch match = look(middle);
    if (error(match) < error(best)) best = match;
    (match.found > fragments ? low : high) = middle;
  }
  return best;
}

Mesh sized_triangles(int width, int height, int count, double least, double most,
                     std::uint64_t seed) {
  Numbers numbers(seed);
  const double w = width, h = height;
  most = std::min(most, w * h / 2);
  if (least >= most) throw Error(Errc::invalid_argument, "the picture is too small");
  Mesh mesh;
  while (mesh.triangle_count() < static_cast<std::size_t>(count)) {
    // Areas are uniform in their logarithm. A random shape is moved and scaled to its area, if it
    // fits.
    const double area = least * std::pow(most / least, numbers.unit());
    std::array<double, 6> p;
    for (double& v : p) v = numbers.unit();
    const double is = std::abs((p[2] - p[0]) * (p[5] - p[1]) - (p[4] - p[0]) * (p[3] - p[1])) / 2;
    if (is < 0.02) continue;  // slivers would leave the picture
    const double scale = std::sqrt(area / is);
    const double span_x = scale * (std::max({p[0], p[2], p[4]}) - std::min({p[0], p[2], p[4]}));
    const double span_y = scale * (std::max({p[1], p[3], p[5]}) - std::min({p[1], p[3], p[5]}));
    if (span_x >= w || span_y >= h) continue;
    const double left = numbers.unit() * (w - span_x) - scale * std::min({p[0], p[2], p[4]});
    const double top = numbers.unit() * (h - span_y) - scale * std::min({p[1], p[3], p[5]});
    for (std::size_t c = 0; c < 3; ++c) {
      mesh.indices.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
      mesh.positions.push_back({static_cast<float>(left + scale * p[2 * c]),
                                static_cast<float>(h - top - scale * p[2 * c + 1]),
                                static_cast<float>(-0.05 - 0.9 * numbers.unit())});
    }
  }
  return mesh;
}

const char* name(Order order) {
  constexpr const char* kNames[] = {"front to back", "random", "back to front"};
  return kNames[static_cast<std::size_t>(order)];
}

Mesh sheets(int width, int height, int layers, int cells, Order order) {
  Mesh mesh;
  const auto side = static_cast<std::uint32_t>(cells + 1);
  for (int k = 0; k < layers; ++k) {
    const int layer = order == Order::back_to_front ? layers - 1 - k : k;
    const auto base = static_cast<std::uint32_t>(mesh.positions.size());
    const float gap = 0.9F / static_cast<float>(layers);
    for (int y = 0; y <= cells; ++y)
      for (int x = 0; x <= cells; ++x) {
        const float u = static_cast<float>(x) / static_cast<float>(cells);
        const float v = static_cast<float>(y) / static_cast<float>(cells);
        // The waves stay below half a gap, so sheets never meet.
        const float wave = 0.4F * gap * std::sin(9 * u + static_cast<float>(layer)) *
                           std::cos(7 * v - static_cast<float>(layer));
        mesh.positions.push_back({u * static_cast<float>(width), v * static_cast<float>(height),
                                  -0.05F - gap * (static_cast<float>(layer) + 0.5F) + wave});
      }
    for (std::uint32_t y = 0; y + 1 < side; ++y)
      for (std::uint32_t x = 0; x + 1 < side; ++x) {
        const std::uint32_t a = base + y * side + x, b = a + 1, c = a + side, d = c + 1;
        mesh.indices.insert(mesh.indices.end(), {a, b, d, a, d, c});
      }
  }
  if (order == Order::random) {
    Numbers numbers(5);
    for (std::size_t i = mesh.indices.size() / 3; i > 1; --i) {
      const std::size_t j = numbers.below(i);
      if (j == i - 1) continue;
      std::swap_ranges(mesh.indices.begin() + static_cast<std::ptrdiff_t>(3 * (i - 1)),
                       mesh.indices.begin() + static_cast<std::ptrdiff_t>(3 * i),
                       mesh.indices.begin() + static_cast<std::ptrdiff_t>(3 * j));
    }
  }
  return mesh;
}

}  // namespace rastrum::bench
