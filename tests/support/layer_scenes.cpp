// SPDX-License-Identifier: BSD-3-Clause
// One function per kind, in the order of the table at the end.
#include "tests/support/layer_scenes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>

#include <rastrum/core/elementary.hpp>

#include "tests/support/random.hpp"
#include "tests/support/scenes.hpp"

namespace rastrum::test {
namespace {

constexpr double kPi = 3.14159265358979323846;

std::uint64_t mix(std::uint64_t v) {
  return Random(v).bits();
}

/// The alphas of a scene: in some the first layers decide the colour, in others all layers.
class Alphas {
 public:
  Alphas(Random& r, int layers) : random_(&r), layers_(layers), style_(r.integer(0, 4)) {}

  double operator()() {
    Random& r = *random_;
    switch (style_) {
      case 0:
        return r.real(0, 1);
      case 1:
        return r.real(0, std::min(1.0, 3.0 / layers_));
      case 2:  // sometimes invisible or opaque
        return r.chance(0.15) ? 0 : r.chance(0.1) ? 1 : r.real(0, std::min(1.0, 10.0 / layers_));
      case 3:
        return elementary::pow(10.0, r.real(-7, 0));
      default:
        return 0.5;
    }
  }

 private:
  Random* random_;
  int layers_, style_;
};

struct Maker {
  Random random;
  int width, height, most_fragments;
  LayerScene scene;
  bool flat = false;  ///< the pixel camera: w = 1, and depths are given directly

  Maker(std::uint64_t seed, int w, int h, int most)
      : random(seed), width(w), height(h), most_fragments(most) {}

  [[nodiscard]] int most_layers() const { return std::max(most_fragments / (width * height), 1); }

  /// z in [0, 1], 1 nearest.
  Vec3 at(double x_px, double y_px, double z) const {
    if (flat) return at_pixel(x_px, y_px, z, width, height);
    return Placer(scene.camera, width, height).at({x_px, y_px, 0.2 + 4 * (1 - z)});
  }
  std::uint32_t vertex(Vec3 p) {
    scene.mesh.positions.push_back(p);
    return static_cast<std::uint32_t>(scene.mesh.positions.size() - 1);
  }
  Vec4 color(double alpha) {
    const auto channel = [&] { return static_cast<float>(alpha * random.real(0, 1)); };
    return {channel(), channel(), channel(), static_cast<float>(alpha)};
  }
  void triangle(Vec3 a, Vec3 b, Vec3 c, Vec4 paint, bool opaque = false) {
    const std::uint32_t i = vertex(a), j = vertex(b), k = vertex(c);
    scene.add(i, j, k, paint, opaque);
  }
  /// A primitive with the corners that successive calls of corner() return.
  template <class F>
  void triangle_of(const F& corner, Alphas& alpha, bool opaque = false) {
    const Vec3 a = corner(), b = corner(), c = corner();
    triangle(a, b, c, color(opaque ? 1 : alpha()), opaque);
  }
  /// A triangle whose corners are at most `size` from a place.
  void triangle_about(double x_px, double y_px, double size, Alphas& alpha, bool opaque = false) {
    const auto corner = [&] {
      const double u = x_px + random.real(-size, size), v = y_px + random.real(-size, size);
      return at(u, v, random.real(0, 1));
    };
    triangle_of(corner, alpha, opaque);
  }
  void quad(const std::array<Vec3, 4>& p, Vec4 paint, bool opaque = false) {
    const std::uint32_t i = vertex(p[0]), j = vertex(p[1]), k = vertex(p[2]), l = vertex(p[3]);
    scene.add(i, j, k, paint, opaque);
    scene.add(i, k, l, paint, opaque);
  }
  double x() { return random.real(-0.3 * width, 1.3 * width); }
  double y() { return random.real(-0.3 * height, 1.3 * height); }
  double larger() const { return std::max(width, height); }
  /// 1 to `most`, evenly over orders of magnitude, limited to the picture's budget.
  int count(int most) {
    const double log_most = elementary::log(static_cast<double>(std::min(most, most_layers())));
    return std::max(1, static_cast<int>(std::lround(elementary::exp(random.real(0, log_most)))));
  }
  void look_flat() {
    flat = true;
    scene.camera = pixel_camera(width, height);
  }
  void look() {
    if (random.chance(0.5)) return look_flat();
    scene.camera.eye = {0.3F, -0.2F, 2};
    scene.camera.target = {0.1F, 0.4F, -1};
    scene.camera.near_plane = 0.1F;
    if (random.chance(0.3)) scene.camera.far_plane = 5;
  }
};

// Large quads in any position that cross each other.
void crossing_quads(Maker& m) {
  m.look();
  const int n = m.count(60);
  Alphas alpha(m.random, n);
  for (int i = 0; i < n; ++i) {
    const double x = m.x(), y = m.y(), turn = m.random.real(0, 2 * kPi), size = m.larger();
    const double dx = size * elementary::cos(turn), dy = size * elementary::sin(turn);
    const Vec4 color = m.color(alpha());
    const auto z = [&] { return m.random.real(0, 1); };
    m.quad({m.at(x - dx, y - dy, z()), m.at(x + dy, y - dx, z()), m.at(x + dx, y + dy, z()),
            m.at(x - dy, y + dx, z())},
           color);
  }
}

// Rectangles in few planes: depths are equal everywhere, so the first submitted is in front.
void coplanar(Maker& m) {
  m.look_flat();
  const int n = m.count(200);
  const int planes = m.random.integer(1, 4);
  Alphas alpha(m.random, n);
  for (int i = 0; i < n; ++i) {
    const double x0 = m.x(), x1 = m.x(), y0 = m.y(), y1 = m.y();
    const double z = m.random.integer(0, planes) / 4.0;
    m.quad({m.at(x0, y0, z), m.at(x0, y1, z), m.at(x1, y1, z), m.at(x1, y0, z)}, m.color(alpha()));
  }
}

// The same sloping triangles, again and again from another corner or side. Their planes are equal
// but for rounding, so neighbouring pixels differ in which is in front.
void repeated(Maker& m) {
  m.look();
  const int n = m.count(300);
  Alphas alpha(m.random, n);
  std::array<Vec3, 3> p{};
  for (int i = 0; i < n; ++i) {
    if (i % 40 == 0)
      for (Vec3& v : p) {
        const double z = m.random.real(0, 1), y = m.y(), x = m.x();
        v = m.at(x, y, z);
      }
    const auto k = static_cast<std::size_t>(m.random.integer(0, 2));
    const bool turned = m.random.chance(0.5);
    m.triangle(p[k], p[(k + (turned ? 2 : 1)) % 3], p[(k + (turned ? 1 : 2)) % 3],
               m.color(alpha()));
  }
}

// Up to 2,000 slightly sloping layers in random order.
void stack(Maker& m) {
  m.look();
  const int n = m.random.chance(0.3) ? m.count(2000) : std::min(m.count(2000) * 8, 2000);
  Alphas alpha(m.random, n);
  const double slope = m.random.chance(0.5) ? 0 : m.random.real(0, 0.3);
  for (int i = 0; i < std::min(n, m.most_layers()); ++i) {
    const double z = m.random.real(0, 1), s = m.random.real(-slope, slope);
    const auto corner = [&](double u, double v, double lean) {
      return m.at(u * m.width, v * m.height, std::clamp(z + lean, 0.0, 1.0));
    };
    m.quad(
        {corner(-0.1, -0.1, -s), corner(-0.1, 1.1, 0), corner(1.1, 1.1, s), corner(1.1, -0.1, 0)},
        m.color(alpha()));
  }
}

// Strands of hair: crossing bands of at most a pixel in width.
void ribbons(Maker& m) {
  m.look();
  const int n = m.count(60), segments = 16;
  Alphas alpha(m.random, n / 4 + 1);
  for (int i = 0; i < n; ++i) {
    const double cx = m.x(), cy = m.y(), radius = m.random.real(0.1, 1) * m.larger();
    const double start = m.random.real(0, 2 * kPi), thin = elementary::exp(m.random.real(-3, 1.5));
    const double z0 = m.random.real(0, 1), z1 = m.random.real(0, 1);
    const Vec4 color = m.color(alpha());
    std::uint32_t before[2] = {};
    for (int s = 0; s <= segments; ++s) {
      const double t = s / static_cast<double>(segments), angle = start + 2.5 * t;
      const double z = z0 + (z1 - z0) * t;
      std::uint32_t now[2];
      for (int side = 0; side < 2; ++side) {
        const double r = radius + thin * side;
        now[side] =
            m.vertex(m.at(cx + r * elementary::cos(angle), cy + r * elementary::sin(angle), z));
      }
      if (s > 0) {
        m.scene.add(before[0], before[1], now[0], color);
        m.scene.add(before[1], now[1], now[0], color);
      }
      std::copy(now, now + 2, before);
    }
  }
}

// Opaque quads cut through translucent ones, some at exactly their depth.
void opaque_between(Maker& m) {
  m.look();
  const int n = m.count(80);
  Alphas alpha(m.random, n / 2 + 1);
  for (int i = 0; i < n; ++i) {
    const bool opaque = i / 5 % 3 == 1;  // runs, which become draws of their own
    const double x = m.x(), y = m.y(), size = m.larger() * m.random.real(0.1, 0.8);
    const bool level = m.random.chance(0.4);
    const double z = m.random.integer(0, 6) / 8.0;
    const Vec4 color = m.color(opaque ? 1 : alpha());
    const auto depth = [&] { return level ? z : m.random.real(0, 1); };
    m.quad({m.at(x - size, y - size, depth()), m.at(x - size, y + size, depth()),
            m.at(x + size, y + size, depth()), m.at(x + size, y - size, depth())},
           color, opaque);
  }
}

// Corners on both sides of the near plane and of the eye.
void near_crossing(Maker& m) {
  m.scene.camera.eye = {0, 0, 0};
  m.scene.camera.target = {0, 0, -1};
  m.scene.camera.near_plane = 0.1F;
  const int n = m.count(60);
  Alphas alpha(m.random, n);
  for (int i = 0; i < n; ++i) {
    const auto corner = [&] {
      const double x = m.random.real(-2, 2), y = m.random.real(-2, 2);
      const double z = m.random.chance(0.4) ? m.random.real(-0.05, 0.3) : m.random.real(0.1, 4);
      return Vec3{static_cast<float>(x), static_cast<float>(y), static_cast<float>(-z)};
    };
    m.triangle_of(corner, alpha);
  }
}

// Heaps of triangles of at most a pixel.
void micro(Maker& m) {
  m.look();
  const int n = m.random.integer(1, 4000), heaps = m.random.integer(1, 6);
  Alphas alpha(m.random, 10);
  const double spread = m.random.real(1, 0.4 * m.larger() + 1);
  for (int i = 0; i < n; ++i) {
    Random heap(static_cast<std::uint64_t>(i % heaps) + 77);
    const double cx = heap.real(0, m.width), cy = heap.real(0, m.height);
    const double x = cx + m.random.real(-spread, spread), y = cy + m.random.real(-spread, spread);
    const double size = elementary::exp(m.random.real(-2, 1.2));
    m.triangle_about(x, y, size, alpha);
  }
}

// Wavy sheets with shared edges that cross each other, like meshes in files.
void sheets(Maker& m) {
  m.look();
  const int n = std::min(m.count(12), 12), cells = m.random.integer(1, 10);
  Alphas alpha(m.random, n);
  for (int i = 0; i < n; ++i) {
    const double z = m.random.real(0.2, 0.8), wave = m.random.real(0, 0.2);
    const Vec4 color = m.color(alpha());
    const auto first = static_cast<std::uint32_t>(m.scene.mesh.positions.size());
    for (int v = 0; v <= cells; ++v)
      for (int u = 0; u <= cells; ++u)
        m.vertex(m.at(m.width * (1.2 * u / cells - 0.1), m.height * (1.2 * v / cells - 0.1),
                      z + m.random.real(-wave, wave)));
    for_each_cell(cells, cells, first, [&](auto a, auto b, auto c, auto d) {
      m.scene.add(a, c, b, color);
      m.scene.add(b, c, d, color);
    });
  }
}

// Triangles of every size.
void soup(Maker& m) {
  m.look();
  const int n = m.count(400);
  Alphas alpha(m.random, n / 4 + 1);
  for (int i = 0; i < n; ++i) {
    const double x = m.x(), y = m.y(), size = elementary::exp(m.random.real(-1, 5));
    m.triangle_about(x, y, size, alpha, i % 50 < 5);
  }
}

// The difficult geometry of scenes.hpp: clipped, degenerate, not finite, nearly edge-on, ….
void family(Maker& m) {
  GeneratedScene g = generate(m.random.bits() >> 1, m.width, m.height);
  // Coordinates near FLT_MAX overflow a program's float32 clip position.
  while (g.kind == "extreme") g = generate(m.random.bits() >> 1, m.width, m.height);
  m.scene.kind.append("/").append(g.kind);
  m.scene.camera = g.camera;
  m.scene.mesh.positions = g.scene.meshes[0].positions;
  const std::vector<std::uint32_t> indices = indexed(g.scene.meshes[0]).indices;
  Alphas alpha(m.random, 10);
  const int run = m.random.integer(3, 20);
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
    const bool opaque = static_cast<int>(i / 3) / run % 4 == 3;
    m.scene.add(indices[i], indices[i + 1], indices[i + 2], m.color(opaque ? 1 : alpha()), opaque);
  }
}

struct Kind {
  const char* name;
  void (*make)(Maker&);
};
constexpr std::array kKinds = {
    Kind{"crossing_quads", crossing_quads},
    Kind{"coplanar", coplanar},
    Kind{"repeated", repeated},
    Kind{"stack", stack},
    Kind{"ribbons", ribbons},
    Kind{"opaque_between", opaque_between},
    Kind{"near_crossing", near_crossing},
    Kind{"micro", micro},
    Kind{"sheets", sheets},
    Kind{"soup", soup},
    Kind{"family", family},
};

Rgba64 wide(Vec4 c) {
  return {double{c.x}, double{c.y}, double{c.z}, double{c.w}};
}

}  // namespace

const int kLayerKinds = static_cast<int>(kKinds.size());

void LayerScene::add(std::uint32_t a, std::uint32_t b, std::uint32_t c, Vec4 color,
                     bool is_opaque) {
  mesh.indices.insert(mesh.indices.end(), {a, b, c});
  colors.push_back(color);
  opaque.push_back(is_opaque ? 1 : 0);
}

Vec4 LayerScene::pixel_color(std::uint64_t id, int x, int y) const {
  const std::uint64_t h =
      mix(id << 32 ^ static_cast<std::uint64_t>(y) << 16 ^ static_cast<std::uint64_t>(x));
  const auto factor = [&](int shift) {
    return 0.5F + 0.5F * static_cast<float>(h >> shift & 255) / 255;
  };
  const Vec4 c = colors[static_cast<std::size_t>(id)];
  const float a = opaque[static_cast<std::size_t>(id)] != 0 ? 1 : factor(0);
  return {c.x * a * factor(8), c.y * a * factor(16), c.z * a * factor(24), c.w * a};
}

bool LayerScene::is_hole(std::uint64_t id, int x, int y) const {
  return holes && id % 2 == 0 &&
         mix(id << 32 ^ static_cast<std::uint64_t>(x) << 16 ^ static_cast<std::uint64_t>(y)) % 3 ==
             0;
}

LayerScene generate_layers(std::uint64_t seed, int width, int height, int most_fragments) {
  const Kind& kind = kKinds[seed % kKinds.size()];
  Maker m(seed * 0x2545F4914F6CDD1DU + 5, width, height, most_fragments);
  m.scene.kind = kind.name;
  kind.make(m);
  LayerScene scene = std::move(m.scene);
  const int paint = m.random.integer(0, 3);
  scene.holes = m.random.chance(0.2);
  if (paint == 1) scene.paint = Paint::pixel;
  if (paint == 2 && m.flat) {
    scene.paint = Paint::gradient;
    for (std::size_t i = 0; i < scene.mesh.indices.size(); ++i) {
      const Vec4 c = scene.colors[i / 3];
      const auto factor = m.random.real32(0, 1);
      const bool opaque = scene.opaque[i / 3] != 0;
      scene.corner_colors.push_back(
          {c.x * factor, c.y * factor, c.z * factor, opaque ? 1 : c.w * factor});
    }
  }
  return scene;
}

LayerScene layer_stack(std::uint64_t seed, int count, double alpha, int width, int height) {
  Maker m(seed, width, height, count);
  m.scene.kind = "layer_stack";
  m.look_flat();
  std::vector<int> order(static_cast<std::size_t>(count));
  std::iota(order.begin(), order.end(), 0);
  for (std::size_t i = order.size(); i > 1; --i)
    std::swap(order[i - 1], order[static_cast<std::size_t>(m.random.integer(0, int(i) - 1))]);
  for (const int k : order) {
    const double z = (k + 0.5) / count;
    m.quad({m.at(-1, -1, z), m.at(-1, height + 1, z), m.at(width + 1, height + 1, z),
            m.at(width + 1, -1, z)},
           m.color(alpha * m.random.real(0.5, 1)));
  }
  return std::move(m.scene);
}

LayerScene overlapping_pieces() {
  // Found by a search. The first corner is beside the guard band, the last barely behind the near
  // plane. They cut off a part that is about a snapping step wide, in the middle of the fan.
  LayerScene scene;
  scene.kind = "overlapping_pieces";
  scene.camera.eye = {0, 0, 0};
  scene.camera.target = {0, 0, -1};
  scene.camera.near_plane = 0.1F;
  scene.mesh.positions = {
      {-706.188293F, -0.039451614F, -0.5F},
      {0.323428512F, 0.210162237F, -0.5F},
      {0.00607562531F, 0.0351930633F, -0.0999995321F},
      {722.457092F, 0.481751621F, -0.5F},
      {0.385045379F, -0.12634553F, -0.5F},
      {-0.0254268497F, -0.0388722382F, -0.0999996141F},
      {-343.240936F, -0.287163258F, -0.5F},
      {0.00439171772F, -0.061611034F, -0.5F},
      {0.0271349885F, 0.0226431675F, -0.0999943838F},
      {935.252075F, 0.406848699F, -0.5F},
      {0.00598360365F, -0.0676583126F, -0.5F},
      {-0.0667591467F, -0.0406496301F, -0.0999973491F},
      {-701.455078F, -0.0696747825F, -0.5F},
      {0.275118619F, 0.45087567F, -0.5F},
      {0.0818680674F, 0.0568387695F, -0.0999991074F},
      {-308.243958F, -0.0928642079F, -0.5F},
      {0.305543631F, 0.353243381F, -0.5F},
      {0.0862086564F, 0.0424581245F, -0.0999989733F},
      {620.030151F, 0.355757147F, -0.5F},
      {0.0987962559F, -0.282826483F, -0.5F},
      {0.00155374862F, -0.00271855504F, -0.0999995917F},
      {-710.743958F, 0.177131549F, -0.5F},
      {-0.177561224F, -0.117712684F, -0.5F},
      {0.0485489108F, -0.0117430026F, -0.0999993607F},
  };
  Random random(1);
  for (std::uint32_t i = 0; i < scene.mesh.positions.size(); i += 3) {
    const auto channel = [&] { return static_cast<float>(0.5 * random.real(0, 1)); };
    const float r = channel(), g = channel();
    scene.add(i, i + 1, i + 2, {r, g, channel(), 0.5F});
  }
  return scene;
}

LayerQuestion::LayerQuestion(const LayerScene& scene, int width, int height, int samples,
                             Vec4 background)
    : scene_(scene), width_(width), height_(height), samples_(samples) {
  const Vec4 b = background;
  background_ = {double{b.x} * b.w, double{b.y} * b.w, double{b.z} * b.w, double{b.w}};
  const Scene whole = single(scene.mesh);
  const SceneBinding binding(whole);
  pieces = pieces_of(binding.view(), scene.camera, width, height);
}

LayerInput LayerQuestion::input() const {
  LayerInput in;
  in.width = width_;
  in.height = height_;
  in.samples = samples_;
  in.background = background_;
  in.triangles = pieces.triangles;
  const LayerScene& scene = scene_;
  in.is_opaque = [&scene](std::int64_t id) {
    return scene.opaque[static_cast<std::size_t>(id)] != 0;
  };
  if (scene.holes)
    in.is_hole = [&scene](const SnappedTriangle& t, const ShadePoint& p) {
      return scene.is_hole(static_cast<std::uint64_t>(t.id), p.px, p.py);
    };
  in.color = [&scene](const SnappedTriangle& t, const ShadePoint& p) {
    const auto id = static_cast<std::uint64_t>(t.id);
    if (scene.paint == Paint::triangle) return wide(scene.colors[id]);
    if (scene.paint == Paint::pixel) return wide(scene.pixel_color(id, p.px, p.py));
    // Linear over the whole triangle, as drawn if w = 1 and nothing clips.
    Rgba64 sum;
    const auto area = static_cast<double>(twice_area(t));
    for (std::size_t c = 0; c < 3; ++c) {
      const SnappedVertex &a = t.v[(c + 1) % 3], &b = t.v[(c + 2) % 3];
      const double weight = static_cast<double>((b.x_fx8 - a.x_fx8) * (p.y_fx8 - a.y_fx8) -
                                                (b.y_fx8 - a.y_fx8) * (p.x_fx8 - a.x_fx8)) /
                            area;
      sum = sum + wide(scene.corner_colors[3 * id + c]) * weight;
    }
    return sum;
  };
  return in;
}

}  // namespace rastrum::test
