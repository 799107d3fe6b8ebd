// SPDX-License-Identifier: BSD-3-Clause
// `rastrum bench transparency-pictures`: the pictures of docs/transparency_methods.md. They show
// one scene by every technique with its difference to exact, and an enlarged part with 1 and 8
// samples a pixel.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include <bench/options.hpp>
#include <bench/peers/selection.hpp>
#include <bench/registry.hpp>
#include <bench/report.hpp>
#include <rastrum/error.hpp>
#include <rastrum/family.hpp>
#include <rastrum/io.hpp>
#include <rastrum/shapes.hpp>

#include <papers/paper4/bench/measure.hpp>

namespace rastrum::bench {
namespace {

/// Tubes that run through each other and through themselves: up to 16 layers, which no order of
/// triangles or objects gets right.
constexpr std::array kKnots{"torus_knot?p=2&q=3&segments=400&sides=32&tube=0.3",
                            "torus_knot?p=3&q=7&segments=600&sides=24&tube=0.14",
                            "torus_knot?p=2&q=5&segments=400&sides=32&tube=0.22"};
/// The enlarged part: its factor and its place.
constexpr int kEnlarged = 8;
constexpr Vec3 kEdges{0.52F, 0, -0.35F};
constexpr float kRadians = 0.0174532925F;

class Knots {
 public:
  explicit Knots(float opacity) : opacity_(opacity) {
    for (const char* knot : kKnots) meshes_.push_back(shapes::from_spec(knot));
    for (const Mesh& mesh : meshes_) views_.push_back(mesh.view());
    for (const MeshView& view : views_) instances_.push_back({view});
  }

  [[nodiscard]] Image<Vec4> draw(Size size, const TransparencyOptions& transparency, int samples,
                                 const Camera& camera) const {
    FrameOptions o;
    o.width = size.width;
    o.height = size.height;
    o.shader = Shader::normal;
    o.background = {1, 1, 1, 1};
    o.opacity = opacity_;
    o.transparency = transparency;
    o.samples = samples;
    Image<Vec4> picture(size.width, size.height);
    static_cast<void>(family::make_renderer({}, {}).render({.instances = instances_}, camera, o,
                                                           {.color = picture}));
    return picture;
  }

 private:
  float opacity_;
  std::vector<Mesh> meshes_;
  std::vector<MeshView> views_;
  std::vector<InstanceView> instances_;
};

Camera from_above(Vec3 target, float fov_degrees) {
  Camera camera;
  camera.eye = {0, 3.6F, 1.2F};
  camera.target = target;
  camera.fov_rad = fov_degrees * kRadians;
  camera.near_plane = 1;
  return camera;
}

/// Writes the picture with `f` applied to each colour and each pixel enlarged to `scale` px.
template <class F>
void write(const std::filesystem::path& file, const Image<Vec4>& picture, int scale, F&& f) {
  Image<Rgba8> out(picture.width() * scale, picture.height() * scale);
  const auto to_8_bits = [](float v) {
    return static_cast<std::uint8_t>(std::lround(255 * std::clamp(v, 0.0F, 1.0F)));
  };
  for (int y = 0; y < out.height(); ++y)
    for (int x = 0; x < out.width(); ++x) {
      const Vec4 c = f(x / scale, y / scale);
      out(x, y) = {to_8_bits(c.x), to_8_bits(c.y), to_8_bits(c.z), 255};
    }
  io::write_png(file, out.view());
}

}  // namespace

int run_transparency_pictures(std::span<const std::string_view> arguments) {
  std::string out = ".", size_name = "336x336";
  float opacity = 0.4F, amplify = 8;
  OptionParser parser("transparency-pictures", "The pictures of docs/transparency_methods.md.");
  parser.add_option("--out", out, "write the pictures into FOLDER (default: .)")
      ->type_name("FOLDER");
  parser.add_option("--size", size_name, "size of each picture (default: 336x336)")
      ->type_name("WxH");
  parser.add_option("--opacity", opacity, "opacity of every surface (default: 0.4)")
      ->range(0.01, 0.99);
  parser.add_option("--amplify", amplify, "show differences so many times as large (default: 8)")
      ->range(1.0, 255.0);
  if (const auto status = parser.parse(arguments)) return *status;
  const Size size = parse_size(size_name);

  const std::filesystem::path folder = out;
  std::filesystem::create_directories(folder);
  const Knots knots(opacity);
  const Camera whole = from_above({0, 0, 0.1F}, 50);
  const Image<Vec4> exact = knots.draw(size, kTechniques[kExact].options, 1, whole);
  for (const Technique& technique : kTechniques) {
    const Image<Vec4> picture = knots.draw(size, technique.options, 1, whole);
    std::string name = "knots_" + std::string(technique.name);
    std::erase(name, ':');
    write(folder / (name + ".png"), picture, 1, [&](int x, int y) { return picture(x, y); });
    write(folder / (name + "_difference.png"), picture, 1, [&](int x, int y) {
      const Vec4 a = picture(x, y), b = exact(x, y);
      return Vec4{amplify * std::abs(a.x - b.x), amplify * std::abs(a.y - b.y),
                  amplify * std::abs(a.z - b.z), 1};
    });
    const PictureError error = picture_error(exact, picture, 1.0 / 255);
    std::printf("%-9s RMSE %s, worst %s, %s %% of the pixels within 1/255\n",
                std::string(technique.name).c_str(), significant(error.rmse).c_str(),
                significant(error.worst).c_str(), significant(100 * error.share()).c_str());
  }
  const Size part{std::max(1, size.width / kEnlarged), std::max(1, size.height / kEnlarged)};
  for (const int samples : {1, 8}) {
    const Image<Vec4> picture =
        knots.draw(part, kTechniques[kExact].options, samples, from_above(kEdges, 8));
    write(folder / ("knots_samples" + std::to_string(samples) + ".png"), picture, kEnlarged,
          [&](int x, int y) { return picture(x, y); });
  }
  return 0;
}

}  // namespace rastrum::bench
