#include <rastrum/terrain/roll.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <rastrum/terrain/setup.hpp>

namespace rastrum::terrain {
namespace {

struct Turn {
  double cos, sin;
  explicit Turn(double angle) : cos(std::cos(angle)), sin(std::sin(angle)) {
    // A quarter turn of a double is not one of π.
    if (std::abs(cos) < 1e-12) cos = 0;
    if (std::abs(sin) < 1e-12) sin = 0;
  }
};

struct Position {
  double x, y;  ///< px in the upright picture
};
template <class T, class U>
Position position(const Turn& turn, const ImageView<T>& upright, const ImageView<U>& out, int x,
                  int y) {
  const double dx = x + 0.5 - out.width / 2.0, dy = y + 0.5 - out.height / 2.0;
  return {upright.width / 2.0 + (dx * turn.cos - dy * turn.sin),
          upright.height / 2.0 + (dx * turn.sin + dy * turn.cos)};
}

}  // namespace

Upright upright_of(const TerrainOptions& options, const TerrainCamera& camera) {
  const Turn turn(camera.roll_rad);
  const double c = std::abs(turn.cos), s = std::abs(turn.sin);
  const double width = std::ceil(options.width * c + options.height * s - 1e-6);
  const double height = std::ceil(options.width * s + options.height * c - 1e-6);
  if (width > kMaxImageSize || height > kMaxImageSize)
    throw Error(Errc::invalid_argument,
                "terrain: rolled by this angle the picture needs an upright one beyond "
                "32768x32768; choose a smaller size");
  Upright u{options, camera};
  u.options.width = static_cast<int>(width);
  u.options.height = static_cast<int>(height);
  u.options.scale_px = scale_px(options);
  const double wider = width / options.width;
  u.options.fov_rad = options.projection == Projection::planar
                          ? 2 * std::atan(std::tan(options.fov_rad / 2) * wider)
                          : options.fov_rad * wider;
  u.camera.horizon_px += (height - options.height) / 2;
  u.camera.roll_rad = 0;
  return u;
}

void roll_row(const ImageView<const Rgba8>& upright, double roll_rad, int y,
              const ImageView<Rgba8>& out) noexcept {
  const Turn turn(roll_rad);
  for (int x = 0; x < out.width; ++x) {
    const Position at = position(turn, upright, out, x, y);
    // Positions in 1/256 px, so that what is a centre up to rounding is one.
    const auto u = static_cast<std::int64_t>(std::floor((at.x - 0.5) * 256 + 0.5));
    const auto v = static_cast<std::int64_t>(std::floor((at.y - 0.5) * 256 + 0.5));
    const auto tx = static_cast<std::uint32_t>(u & 255), ty = static_cast<std::uint32_t>(v & 255);
    const auto pixel = [&](std::int64_t i, std::int64_t j) {
      return upright(static_cast<int>(std::clamp<std::int64_t>(i, 0, upright.width - 1)),
                     static_cast<int>(std::clamp<std::int64_t>(j, 0, upright.height - 1)));
    };
    const std::int64_t i = u >> 8, j = v >> 8;
    const Rgba8 a = pixel(i, j), b = pixel(i + 1, j), c = pixel(i, j + 1), d = pixel(i + 1, j + 1);
    const auto mix = [&](std::uint8_t Rgba8::*channel) {
      const std::uint32_t above = a.*channel * (256 - tx) + b.*channel * tx;
      const std::uint32_t below = c.*channel * (256 - tx) + d.*channel * tx;
      return static_cast<std::uint8_t>((above * (256 - ty) + below * ty + 32768) >> 16);
    };
    out(x, y) = {mix(&Rgba8::r), mix(&Rgba8::g), mix(&Rgba8::b), mix(&Rgba8::a)};
  }
}

void roll_row(const ImageView<const float>& upright, double roll_rad, int y,
              const ImageView<float>& out) noexcept {
  const Turn turn(roll_rad);
  for (int x = 0; x < out.width; ++x) {
    const Position at = position(turn, upright, out, x, y);
    // As for colours, or the floor of what is a centre up to rounding might be its neighbour.
    const auto pixel = [](double p, int size) {
      return static_cast<int>(std::clamp(std::floor(p + 1e-6), 0.0, size - 1.0));
    };
    out(x, y) = upright(pixel(at.x, upright.width), pixel(at.y, upright.height));
  }
}

}  // namespace rastrum::terrain
