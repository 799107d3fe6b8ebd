// SPDX-License-Identifier: BSD-3-Clause
// KHR_draco_mesh_compression: primitives packed by Draco. Without the library they are refused with
// what to install. A stream's sizes are compared with the document first, because the library
// trusts them.
#include <algorithm>
#include <cstddef>
#include <string>

#include <rastrum/io/gltf_internal.hpp>

#ifdef RASTRUM_HAS_DRACO
#include <draco/compression/decode.h>
#endif

namespace rastrum::io::gltf {

#ifdef RASTRUM_HAS_DRACO

namespace {

/// The beginning of a stream (the Draco bitstream 2.2, sections 3 and 4).
class Beginning {
 public:
  explicit Beginning(Bytes bytes) : bytes_(bytes) {}

  std::size_t byte() {
    if (at_ >= bytes_.size()) {
      is_cut_ = true;
      return 0;
    }
    return std::to_integer<std::size_t>(bytes_[at_++]);
  }
  /// Seven bits per byte, the lowest first.
  std::size_t number() {
    std::size_t r = 0;
    for (unsigned shift = 0; shift < 35; shift += 7) {
      const std::size_t b = byte();
      r |= (b & 0x7FU) << shift;
      if (b < 0x80) return r;
    }
    is_cut_ = true;
    return 0;
  }
  void skip(std::size_t bytes) {
    is_cut_ |= bytes > bytes_.size() - at_;
    at_ += std::min(bytes, bytes_.size() - at_);
  }
  /// A tree of metadata: entries with names, then as many branches, each after its name.
  void skip_metadata() {
    for (std::size_t branches = 1; branches != 0 && !is_cut_; --branches) {
      for (std::size_t entries = number(); entries != 0 && !is_cut_; --entries) {
        skip(byte());
        skip(number());
      }
      const std::size_t more = number();
      branches += more;
      // The name of the next branch, wherever in the tree it is.
      if (branches > 1) skip(byte());
    }
  }
  [[nodiscard]] bool is_cut() const { return is_cut_; }

 private:
  Bytes bytes_;
  std::size_t at_ = 0;
  bool is_cut_ = false;
};

/// A stream has at most this many vertices or faces per byte, unless they are few.
constexpr std::size_t kMostPerByte = 1024, kFewVertices = std::size_t{1} << 16;

/// Throws if the stream's sizes contradict the document.
void check_sizes(const Json& extension, Bytes packed, std::size_t vertices, std::size_t faces) {
  Beginning b(packed);
  b.skip(5);
  const std::size_t major = b.byte(), minor = b.byte(), kind = b.byte(), method = b.byte();
  const std::size_t flags = b.byte() | b.byte() << 8;
  if (as_text(packed).substr(0, 5) != "DRACO" || b.is_cut() || kind != 1 || method > 1)
    extension.fail("is no stream of a Draco mesh");
  if (major != 2 || minor != 2)
    extension.fail("has Draco's version " + std::to_string(major) + "." + std::to_string(minor) +
                       "; only 2.2 is read",
                   Errc::unsupported);
  constexpr std::size_t kHasMetadata = 0x8000;
  if ((flags & kHasMetadata) != 0) {
    for (std::size_t n = b.number(); n != 0 && !b.is_cut(); --n) {
      static_cast<void>(b.number());
      b.skip_metadata();
    }
    b.skip_metadata();
  }
  // Sequential: faces, points. Edgebreaker: its kind, vertices before seams are cut, faces.
  const bool sequential = method == 0;
  if (!sequential) static_cast<void>(b.byte());
  const std::size_t first = b.number(), second = b.number();
  const std::size_t has_faces = sequential ? first : second;
  const std::size_t has_vertices = sequential ? second : first;
  if (b.is_cut()) extension.fail("its stream is cut off");
  if (has_faces != faces || (sequential ? has_vertices != vertices : has_vertices > vertices))
    extension.fail("its stream has " + std::to_string(has_faces) + " triangles of " +
                   std::to_string(has_vertices) + " vertices, but its accessors " +
                   std::to_string(faces) + " of " + std::to_string(vertices));
  if (std::max(faces, vertices) > std::max(kFewVertices, packed.size() * kMostPerByte))
    extension.fail("cannot hold " + std::to_string(faces) + " triangles of " +
                   std::to_string(vertices) + " vertices in " + std::to_string(packed.size()) +
                   " bytes");
}

/// The values of all vertices, without gaps, in the type of the accessor.
template <class T>
std::vector<std::byte> values_as(const draco::PointAttribute& attribute, std::size_t vertices,
                                 std::size_t components) {
  std::vector<std::byte> bytes(vertices * components * sizeof(T));
  for (std::size_t v = 0; v < vertices; ++v) {
    T value[4] = {};
    const auto point = draco::PointIndex(static_cast<std::uint32_t>(v));
    if (!attribute.ConvertValue<T>(attribute.mapped_index(point),
                                   static_cast<std::int8_t>(components), value))
      return {};
    std::memcpy(&bytes[v * components * sizeof(T)], value, components * sizeof(T));
  }
  return bytes;
}

std::vector<std::byte> values_of(const draco::PointAttribute& attribute, const AccessorType& type,
                                 std::size_t vertices) {
  return with_component(type.component_type, [&](auto v) {
    return values_as<decltype(v)>(attribute, vertices, type.components);
  });
}

}  // namespace

bool has_draco() {
  return true;
}

Unpacked decode_draco(const Json& primitive, const Json& extension, const Json& document,
                      Bytes packed) {
  const Json accessors = document["accessors"];
  const auto accessor_of = [&](const Json& index) { return accessors.at(index.count()); };
  if (primitive.count("mode", 4) != 4)
    extension.fail("only lists of triangles are read from it", Errc::unsupported);
  const std::size_t vertices = accessor_of(primitive["attributes"]["POSITION"])["count"].count();
  const std::size_t corners = accessor_of(primitive["indices"])["count"].count();
  if (corners % 3 != 0) extension.fail("its indices do not make up whole triangles");
  check_sizes(extension, packed, vertices, corners / 3);

  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(packed.data()), packed.size());
  auto decoded = draco::Decoder().DecodeMeshFromBuffer(&buffer);
  if (!decoded.ok())
    extension.fail("is not a valid stream: " + decoded.status().error_msg_string());
  const draco::Mesh& mesh = *decoded.value();
  if (mesh.num_points() != vertices || mesh.num_faces() != corners / 3)
    extension.fail("has " + std::to_string(mesh.num_faces()) + " triangles of " +
                   std::to_string(mesh.num_points()) + " vertices, but its accessors " +
                   std::to_string(corners / 3) + " of " + std::to_string(vertices));

  Unpacked r;
  r.indices.reserve(corners);
  for (std::uint32_t f = 0; f < mesh.num_faces(); ++f)
    for (std::size_t c = 0; c < 3; ++c)
      r.indices.push_back(mesh.face(draco::FaceIndex(f))[c].value());
  extension["attributes"].for_each_member([&](const std::string& name, const Json& id) {
    const auto index = primitive["attributes"].get(name.c_str());
    if (!index) id.fail("is no attribute of the primitive");
    const std::size_t unique_id = id.count();
    const draco::PointAttribute* const attribute =
        unique_id > 0xFFFFFFFFU
            ? nullptr
            : mesh.GetAttributeByUniqueId(static_cast<std::uint32_t>(unique_id));
    if (attribute == nullptr) id.fail("is not in the stream");
    const Json accessor = accessor_of(*index);
    const AccessorType type = accessor_type(accessor);
    if (type.components == 0 || type.components > 4 ||
        static_cast<std::size_t>(attribute->num_components()) != type.components)
      id.fail("has " + std::to_string(attribute->num_components()) +
              " components, which its accessor does not");
    if (accessor["count"].count() != vertices)
      accessor.fail("has another number of elements than the primitive has vertices");
    r.attributes[name] = values_of(*attribute, type, vertices);
    if (r.attributes[name].empty()) id.fail("has values that do not fit its accessor's type");
  });
  return r;
}

#else

bool has_draco() {
  return false;
}

Unpacked decode_draco(const Json&, const Json& extension, const Json&, Bytes) {
  extension.fail("this rastrum was built without Draco (Debian: libdraco-dev), which unpacks it",
                 Errc::unsupported);
}

#endif

}  // namespace rastrum::io::gltf
