// PLY, binary little-endian: what parse_ply reads back.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include <rastrum/io.hpp>

namespace rastrum::io {
namespace {

static_assert(std::endian::native == std::endian::little,
              "the writer copies this machine's bytes; a big-endian one needs a swap here");

/// A value that 8 bits hold exactly as the reader will divide it.
bool is_byte(float x) {
  const float scaled = std::nearbyint(x * 255);
  return x >= 0 && x <= 1 && scaled * (1 / 255.0F) == x;
}

bool fit_bytes(const std::vector<Vec4>& colors) {
  return std::all_of(colors.begin(), colors.end(), [](const Vec4& c) {
    return is_byte(c.x) && is_byte(c.y) && is_byte(c.z) && is_byte(c.w);
  });
}

/// Collects rows and hands them on in large pieces.
class RowWriter {
 public:
  explicit RowWriter(AtomicFile& out) : out_(out) { bytes_.reserve(kSize); }
  void put(const void* data, std::size_t n) {
    if (bytes_.size() + n > kSize) flush();
    const auto* p = static_cast<const std::byte*>(data);
    bytes_.insert(bytes_.end(), p, p + n);
  }
  void flush() {
    out_.write(bytes_.data(), bytes_.size());
    bytes_.clear();
  }

 private:
  static constexpr std::size_t kSize = std::size_t{1} << 18;
  AtomicFile& out_;
  std::vector<std::byte> bytes_;
};

}  // namespace

void write_ply(AtomicFile& out, const Mesh& mesh) {
  const std::size_t vertices = mesh.positions.size();
  const MeshView view = mesh.view();
  const std::size_t faces = view.triangle_count();
  const auto shared = [&](const auto& attribute, const char* what) {
    if (attribute.empty() || !attribute.indices.empty() || vertices == 0) return false;
    if (attribute.values.size() < vertices)
      throw Error(Errc::invalid_argument, out.name().string() + ": the mesh has " +
                                              std::to_string(vertices) + " positions, but " + what +
                                              " for only " +
                                              std::to_string(attribute.values.size()));
    return true;
  };
  const bool normals = shared(mesh.normals, "normals"),
             texcoords = shared(mesh.texcoords, "texture coordinates"),
             colors = shared(mesh.colors, "colours");
  const bool bytes = colors && fit_bytes(mesh.colors.values);
  for (const std::uint32_t i : mesh.indices)
    if (i >= vertices)
      throw Error(Errc::invalid_argument, out.name().string() + ": the mesh refers to vertex " +
                                              std::to_string(i) + " of " +
                                              std::to_string(vertices));

  std::string header = "ply\nformat binary_little_endian 1.0\nelement vertex " +
                       std::to_string(vertices) +
                       "\nproperty float x\nproperty float y\nproperty float z\n";
  if (normals) header += "property float nx\nproperty float ny\nproperty float nz\n";
  if (texcoords) header += "property float s\nproperty float t\n";
  if (colors)
    for (const char* c : {"red", "green", "blue", "alpha"})
      header += std::string("property ") + (bytes ? "uchar " : "float ") + c + "\n";
  header += "element face " + std::to_string(faces) +
            "\nproperty list uchar uint vertex_indices\nend_header\n";

  RowWriter rows(out);
  rows.put(header.data(), header.size());
  for (std::size_t i = 0; i < vertices; ++i) {
    rows.put(&mesh.positions[i], sizeof(Vec3));
    if (normals) rows.put(&mesh.normals.values[i], sizeof(Vec3));
    if (texcoords) {
      const Vec2 t = {mesh.texcoords.values[i].x, 1 - mesh.texcoords.values[i].y};
      rows.put(&t, sizeof t);
    }
    if (!colors) continue;
    const Vec4 c = mesh.colors.values[i];
    if (bytes) {
      const float scaled[4] = {c.x * 255, c.y * 255, c.z * 255, c.w * 255};
      std::uint8_t b[4];
      for (int k = 0; k < 4; ++k) b[k] = static_cast<std::uint8_t>(std::lround(scaled[k]));
      rows.put(b, sizeof b);
    } else {
      rows.put(&c, sizeof c);
    }
  }
  for (std::size_t t = 0; t < faces; ++t) {
    std::byte face[13] = {std::byte{3}};
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t i = view.vertex(3 * t + c);
      std::memcpy(face + 1 + 4 * c, &i, 4);
    }
    rows.put(face, sizeof face);
  }
  rows.flush();
}

}  // namespace rastrum::io
