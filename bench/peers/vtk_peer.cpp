// SPDX-License-Identifier: BSD-3-Clause
#include "vtk_peer.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <vector>

#include <rastrum/error.hpp>

#include "child.hpp"

namespace rastrum::bench {

struct VtkPeer::Impl {
  TemporaryFile file;
  std::optional<Child> child;
  int width = 0, height = 0;
  std::string description;

  explicit Impl(int threads) {
    setenv("LP_NUM_THREADS", std::to_string(threads).c_str(), 1);
    setenv("GALLIUM_DRIVER", "llvmpipe", 1);
    setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
    const char* const chosen = std::getenv("RASTRUM_VTK_PYTHON");
    child.emplace("VTK", std::vector<std::string>{chosen != nullptr ? chosen : "/usr/bin/python3",
                                                  RASTRUM_BENCH_DIR "/peers/vtk_peer.py"});
    try {
      description = answer();
    } catch (const Error& e) {
      throw Error(Errc::no_device, e.what());
    }
  }

  /// The rest of the answer's line after "done".
  [[nodiscard]] std::string answer() const {
    const std::string line = child->line();
    if (line.starts_with("done")) return line.substr(std::min<std::size_t>(line.size(), 5));
    throw Error(Errc::unsupported, "VTK: " + (line.empty() ? "its process ended" : line));
  }

  void tell(const std::string& command) const {
    child->tell(command);
    static_cast<void>(answer());
  }
};

VtkPeer::VtkPeer(int threads) : impl_(std::make_unique<Impl>(threads)) {}
VtkPeer::~VtkPeer() = default;

std::string VtkPeer::description() const {
  return impl_->description;
}

void VtkPeer::set_mesh(const MeshView& mesh) {
  if (!mesh.normals.indices.empty() || mesh.normals.values.size() != mesh.positions.size() ||
      mesh.indices.empty())
    throw Error(Errc::invalid_argument, "VtkPeer: normals must share the positions' indices");
  impl_->file.write(mesh.positions.packed(), mesh.normals.values.packed(), mesh.indices.packed());
  impl_->tell("mesh " + impl_->file.name() + " " + std::to_string(mesh.positions.size()) + " " +
              std::to_string(mesh.triangle_count()));
}

void VtkPeer::set_spheres(std::span<const Vec3> centers, std::span<const float> radii) {
  impl_->file.write(centers, radii.first(centers.size()));
  impl_->tell("spheres " + impl_->file.name() + " " + std::to_string(centers.size()));
}

void VtkPeer::set_points(std::span<const Vec3> positions) {
  impl_->file.write(positions);
  impl_->tell("points " + impl_->file.name() + " " + std::to_string(positions.size()));
}

void VtkPeer::set_view(const Camera& camera, int width, int height) {
  if (camera.orthographic || camera.matrix)
    throw Error(Errc::unsupported, "VtkPeer: the camera is no perspective one");
  char numbers[400];
  std::snprintf(numbers, sizeof numbers, "%.9g %.9g %.9g %.9g %.9g %.9g %.9g %.9g %.9g %.9g",
                static_cast<double>(camera.fov_rad), camera.eye.x, camera.eye.y, camera.eye.z,
                camera.target.x, camera.target.y, camera.target.z, camera.up.x, camera.up.y,
                camera.up.z);
  impl_->tell("view " + std::to_string(width) + " " + std::to_string(height) + " " + numbers);
  impl_->width = width;
  impl_->height = height;
}

void VtkPeer::set_occlusion(double radius) {
  char text[64];
  std::snprintf(text, sizeof text, "occlusion %.9g", radius);
  impl_->tell(text);
}

void VtkPeer::draw(float opacity) {
  impl_->tell("draw " + std::to_string(opacity));
}

Image<Vec4> VtkPeer::picture() {
  Image<Vec4> image(impl_->width, impl_->height);
  impl_->tell("picture " + impl_->file.name());
  std::vector<Rgba8> pixels(image.pixels().size());
  std::ifstream in(impl_->file.name(), std::ios::binary);
  in.read(reinterpret_cast<char*>(pixels.data()),
          static_cast<std::streamsize>(pixels.size() * sizeof(Rgba8)));
  if (!in) throw Error(Errc::io, "VTK wrote no picture into " + impl_->file.name());
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const auto unit = [](std::uint8_t v) { return static_cast<float>(v) * (1.0F / 255); };
    image.pixels()[i] = {unit(pixels[i].r), unit(pixels[i].g), unit(pixels[i].b),
                         unit(pixels[i].a)};
  }
  return image;
}

}  // namespace rastrum::bench
