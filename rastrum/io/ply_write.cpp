// SPDX-License-Identifier: BSD-3-Clause
// PLY, binary little-endian: what parse_ply reads back.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include <rastrum/io.hpp>

namespace rastrum::io {
namespace {

static_assert(std::endian::native == std::endian::little,
              "the writer copies this machine's bytes; a big-endian one needs a swap here");

/// Whether 8 bits hold the value exactly as the reader will divide it.
bool is_byte(float x) {
  const float scaled = std::nearbyint(x * 255);
  return x >= 0 && x <= 1 && scaled * (1 / 255.0F) == x;
}

bool fit_bytes(std::span<const Vec4> colors) {
  return std::all_of(colors.begin(), colors.end(), [](const Vec4& c) {
    return is_byte(c.x) && is_byte(c.y) && is_byte(c.z) && is_byte(c.w);
  });
}

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

/// Empty attributes are left out.
struct Vertices {
  std::span<const Vec3> positions, normals;
  std::span<const Vec2> texcoords;
  std::span<const Vec4> colors;
  std::vector<const NamedScalars*> scalars{};
  std::span<const Vec3d> wide{};  ///< float64 positions, which replace the others; empty: none
};

std::string word_of(const std::string& name) {
  std::string word = name.empty() ? "scalars" : name;
  for (char& c : word)
    if (static_cast<unsigned char>(c) <= ' ') c = '_';
  return word;
}

/// The scalars that PLY can hold: one number per vertex or face.
std::vector<const NamedScalars*> scalars_of(const AtomicFile& out,
                                            const std::vector<NamedScalars>& all, Per per,
                                            std::size_t count) {
  std::vector<const NamedScalars*> chosen;
  for (const NamedScalars& s : all) {
    if (s.per != per || s.values.empty()) continue;
    if (s.values.size() < count)
      throw Error(Errc::invalid_argument, out.name() + ": there are " +
                                              std::to_string(s.values.size()) + " scalars '" +
                                              s.name + "', but " + std::to_string(count) +
                                              (per == Per::face ? " faces" : " positions"));
    chosen.push_back(&s);
  }
  return chosen;
}

/// `faces`: null: no element for them.
void write_vertices(AtomicFile& out, const Vertices& v, const MeshView* faces,
                    const std::vector<const NamedScalars*>& face_scalars = {}) {
  const std::size_t vertices = v.positions.size();
  const bool bytes = fit_bytes(v.colors);
  std::string header =
      "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(vertices) + "\n";
  for (const char* c : {"x", "y", "z"})
    header += std::string("property ") + (v.wide.empty() ? "float " : "double ") + c + "\n";
  if (!v.normals.empty()) header += "property float nx\nproperty float ny\nproperty float nz\n";
  if (!v.texcoords.empty()) header += "property float s\nproperty float t\n";
  if (!v.colors.empty())
    for (const char* c : {"red", "green", "blue", "alpha"})
      header += std::string("property ") + (bytes ? "uchar " : "float ") + c + "\n";
  for (const NamedScalars* s : v.scalars) header += "property double " + word_of(s->name) + "\n";
  const std::size_t face_count = faces == nullptr ? 0 : faces->triangle_count();
  if (faces != nullptr)
    header += "element face " + std::to_string(face_count) +
              "\nproperty list uchar uint vertex_indices\n";
  for (const NamedScalars* s : face_scalars) header += "property double " + word_of(s->name) + "\n";
  header += "end_header\n";

  RowWriter rows(out);
  rows.put(header.data(), header.size());
  for (std::size_t i = 0; i < vertices; ++i) {
    if (v.wide.empty())
      rows.put(&v.positions[i], sizeof(Vec3));
    else
      rows.put(&v.wide[i], sizeof(Vec3d));
    if (!v.normals.empty()) rows.put(&v.normals[i], sizeof(Vec3));
    if (!v.texcoords.empty()) {
      const Vec2 t = {v.texcoords[i].x, 1 - v.texcoords[i].y};
      rows.put(&t, sizeof t);
    }
    if (!v.colors.empty() && bytes) {
      const auto byte = [](float x) { return static_cast<std::uint8_t>(std::lround(x * 255)); };
      const Vec4 c = v.colors[i];
      const std::uint8_t rgba[] = {byte(c.x), byte(c.y), byte(c.z), byte(c.w)};
      rows.put(rgba, sizeof rgba);
    } else if (!v.colors.empty()) {
      rows.put(&v.colors[i], sizeof(Vec4));
    }
    for (const NamedScalars* s : v.scalars) rows.put(&s->values[i], sizeof(double));
  }
  for (std::size_t t = 0; t < face_count; ++t) {
    std::byte face[13] = {std::byte{3}};
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t i = faces->vertex(3 * t + c);
      std::memcpy(face + 1 + 4 * c, &i, 4);
    }
    rows.put(face, sizeof face);
    for (const NamedScalars* s : face_scalars) rows.put(&s->values[t], sizeof(double));
  }
  rows.flush();
}

/// As many `values` as vertices, or none.
template <class T>
std::span<const T> each(const AtomicFile& out, const char* whose, const std::vector<T>& values,
                        std::size_t vertices, const char* what) {
  if (values.empty() || vertices == 0) return {};
  if (values.size() < vertices)
    throw Error(Errc::invalid_argument, out.name() + ": " + whose + std::to_string(vertices) +
                                            " positions, but " + what + " for only " +
                                            std::to_string(values.size()));
  return std::span(values).first(vertices);
}

}  // namespace

void write_ply(AtomicFile& out, const Mesh& mesh) {
  const std::size_t vertices = mesh.positions.size();
  const auto shared = [&](const auto& attribute, const char* what) {
    return attribute.indices.empty() ? each(out, "the mesh has ", attribute.values, vertices, what)
                                     : decltype(each(out, "", attribute.values, vertices, what)){};
  };
  for (const std::uint32_t i : mesh.indices)
    if (i >= vertices)
      throw Error(Errc::invalid_argument, out.name() + ": the mesh refers to vertex " +
                                              std::to_string(i) + " of " +
                                              std::to_string(vertices));
  const MeshView view = mesh.view();
  write_vertices(out,
                 {mesh.positions, shared(mesh.normals, "normals"),
                  shared(mesh.texcoords, "texture coordinates"), shared(mesh.colors, "colours"),
                  scalars_of(out, mesh.scalars, Per::vertex, vertices),
                  each(out, "the mesh has ", mesh.wide_positions, vertices, "float64")},
                 &view, scalars_of(out, mesh.scalars, Per::face, mesh.triangle_count()));
}

void write_ply(AtomicFile& out, const Points& points) {
  const std::size_t n = points.positions.size();
  write_vertices(out,
                 {points.positions,
                  each(out, "there are ", points.normals, n, "normals"),
                  {},
                  each(out, "there are ", points.colors, n, "colours"),
                  scalars_of(out, points.scalars, Per::vertex, n),
                  each(out, "there are ", points.wide_positions, n, "float64")},
                 nullptr);
}

}  // namespace rastrum::io
