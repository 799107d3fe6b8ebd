// SPDX-License-Identifier: BSD-3-Clause
// Shared declarations of the glTF reader's parts; gltf.cpp says how they work together.
#pragma once

#include <cstdint>
#include <list>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <rastrum/io/gltf_json.hpp>
#include <rastrum/io/parse.hpp>
#include <rastrum/io/pictures.hpp>
#include <rastrum/io/reading.hpp>
#include <rastrum/light.hpp>
#include <rastrum/scene/rig.hpp>

namespace rastrum::io::gltf {

/// Checks every reference, range, length and offset of the document, used or not. Throws
/// Error{bad_format | unsupported}; appends warnings.
void check(const Json& document, std::vector<std::string>& warnings);

/// Values of componentType.
constexpr std::size_t kByte = 5120, kUbyte = 5121, kShort = 5122, kUshort = 5123, kUint = 5125,
                      kFloat = 5126;
/// Calls f with a value of the C++ type of a componentType.
template <class F>
auto with_component(std::size_t type, const F& f) {
  switch (type) {
    case kByte:
      return f(std::int8_t{});
    case kUbyte:
      return f(std::uint8_t{});
    case kShort:
      return f(std::int16_t{});
    case kUshort:
      return f(std::uint16_t{});
    case kUint:
      return f(std::uint32_t{});
    default:
      return f(float{});
  }
}
[[nodiscard]] constexpr bool is_unsigned(std::size_t type) {
  return type == kUbyte || type == kUshort || type == kUint;
}

/// componentType and type of an accessor. `components` is 0 for an unknown type.
struct AccessorType {
  std::size_t component_type = 0, component_bytes = 0, components = 0;
  std::size_t element_bytes = 0;  ///< with padding of matrix columns
  std::size_t used_bytes = 0;     ///< without padding of the last column
};
[[nodiscard]] AccessorType accessor_type(const Json& accessor);
/// The size of a componentType. Throws unless it is 5120 to 5126, without 5124.
[[nodiscard]] std::size_t component_bytes(const Json& component_type);

/// Extensions that pack bytes. Without their library the fallback is read: buffers and accessors
/// that hold the same unpacked.
constexpr const char* kMeshopt = "EXT_meshopt_compression";
constexpr const char* kDraco = "KHR_draco_mesh_compression";
constexpr const char* kInstancing = "EXT_mesh_gpu_instancing";
constexpr const char* kSpecularGlossiness = "KHR_materials_pbrSpecularGlossiness";
constexpr const char* kWebp = "EXT_texture_webp";
constexpr const char* kBasisu = "KHR_texture_basisu";
[[nodiscard]] bool has_meshopt();
[[nodiscard]] bool has_draco();

/// Checks that `view` and its extension agree on size and kind.
void check_meshopt(const Json& view, const Json& extension);
/// The bytes of such a view, checked before; `packed`: the extension's. Throws Error{bad_format};
/// Error{unsupported} without the library.
[[nodiscard]] std::vector<std::byte> decode_meshopt(const Json& extension, Bytes packed);

/// Data unpacked by Draco: vertices in the types of their accessors, without gaps.
struct Unpacked {
  std::map<std::string, std::vector<std::byte>> attributes;
  std::vector<std::uint32_t> indices;
};
/// `packed`: the bytes of the extension's view. Throws as decode_meshopt.
[[nodiscard]] Unpacked decode_draco(const Json& primitive, const Json& extension,
                                    const Json& document, Bytes packed);

/// Lights of KHR_lights_punctual at the origin, along −z; none: of an unknown kind. Throws
/// Error{bad_format}.
[[nodiscard]] std::vector<std::optional<Light>> read_lights(const Json& document);
/// The number of a node's light, below `lights`; none: it has none. Throws likewise.
[[nodiscard]] std::optional<std::size_t> light_of_node(const Json& node, std::size_t lights);

class Buffers {
 public:
  Buffers(const Json& document, Reading& reading, std::optional<Bytes> glb_chunk)
      : document_(document), reading_(reading), glb_chunk_(glb_chunk) {}

  /// Counts the memory of arrays made from the bytes.
  [[nodiscard]] Budget& budget() { return reading_.budget; }

  /// The bytes of a buffer view, unpacked. None if they are an application's own (no uri).
  [[nodiscard]] std::optional<Bytes> view(std::size_t index);
  /// The bytes behind a URI: data: or a file beside this one. `where` names it in errors.
  [[nodiscard]] Bytes uri(const std::string& uri, const Json& where);

  /// Whether an accessor has data; without, it holds zeros.
  [[nodiscard]] bool has_bytes(const Json& accessor);
  /// Elements of an accessor as floats, `components` each, normalized if it says so, with sparse
  /// values. `packed`: elements that replace those it refers to.
  [[nodiscard]] std::vector<float> floats(const Json& accessor,
                                          std::optional<Bytes> packed = std::nullopt);
  /// The elements of a SCALAR accessor of unsigned integers.
  [[nodiscard]] std::vector<std::uint32_t> indices(const Json& accessor);

  std::vector<std::string> warnings;

 private:
  [[nodiscard]] std::optional<Bytes> buffer(std::size_t index);
  [[nodiscard]] bool leaves_out(std::size_t buffer) const;
  template <class T, class Convert>
  std::vector<T> elements(const Json& accessor, std::optional<Bytes> packed, Convert convert);

  const Json& document_;
  Reading& reading_;
  std::optional<Bytes> glb_chunk_;
  std::map<std::size_t, std::optional<Bytes>> buffers_;
  std::map<std::size_t, std::vector<std::byte>> unpacked_;  ///< by buffer view
  std::map<std::string, Bytes> uris_;
  std::list<std::vector<std::byte>> decoded_;  ///< the bytes of data URIs
};

/// The affine map of KHR_texture_transform, and the set of texture coordinates it applies to.
struct TextureUse {
  std::size_t set = 0;
  float m[2][3] = {{1, 0, 0}, {0, 1, 0}};
  friend bool operator==(const TextureUse&, const TextureUse&) = default;
};

/// Converts materials and their textures when a primitive first uses them.
class Materials {
 public:
  Materials(const Json& document, Buffers& buffers, Scene& scene);

  /// The index in Scene::materials of a primitive's material, or of none.
  std::uint32_t use(std::optional<std::size_t> material);
  /// Where this material's textures read the mesh.
  [[nodiscard]] TextureUse texture_use(std::optional<std::size_t> material) const;
  /// Fills the textures, once all materials are converted. Removes unreadable ones, with a warning.
  void decode_images();

 private:
  /// A material of specular colour and glossiness, converted once its pictures are read.
  struct Glossy {
    std::size_t material = 0;
    Vec4 diffuse{1, 1, 1, 1};
    Vec3 specular{1, 1, 1};
    float glossiness = 1;
    std::int32_t texture = kNoTexture;  ///< specular colour; glossiness as alpha
  };
  void convert(std::size_t index);
  void convert_glossy(std::size_t index, const Json& extension, const TextureUse& expected,
                      Material& to);
  void finish(const Glossy& glossy);
  std::int32_t texture(const Json& owner, const char* key, const TextureUse& expected);
  std::int32_t load_texture(std::size_t index);
  /// None, with a warning, if it cannot be read.
  std::optional<std::size_t> load_image(const Json& image);

  const Json& document_;
  Buffers& buffers_;
  Scene& scene_;
  std::vector<bool> converted_;
  std::vector<Glossy> glossy_;
  std::optional<std::uint32_t> default_;
  std::map<std::size_t, std::int32_t> textures_;              ///< glTF's index to ours
  std::map<std::size_t, std::optional<std::size_t>> images_;  ///< glTF's index to pictures
  std::map<std::pair<const std::byte*, std::size_t>, std::size_t> picture_at_;  ///< by its bytes
  Pictures pictures_;
  std::vector<std::size_t> picture_of_;  ///< of each texture of ours
};

/// Whether a primitive has positions; else a warning says that it is left out.
[[nodiscard]] bool has_positions(const Json& primitive, std::vector<std::string>& warnings);
/// Whether it has points or lines (modes 0 to 3), not triangles.
[[nodiscard]] bool is_points_or_lines(const Json& primitive);

/// A primitive's attributes and indices, wherever its file keeps them.
class PrimitiveData {
 public:
  /// The primitive must have positions.
  PrimitiveData(const Json& primitive, const Json& document, Buffers& buffers);

  [[nodiscard]] std::size_t vertices() const { return vertices_; }
  [[nodiscard]] Budget& budget() const { return buffers_.budget(); }
  [[nodiscard]] std::optional<Json> attribute(const std::string& name) const;
  /// One vector of floats per vertex; colours of three components get alpha 1. The primitive must
  /// have the attribute.
  template <class T>
  [[nodiscard]] std::vector<T> read(const std::string& name) const;
  /// Likewise for another accessor. `packed`: as for Buffers::floats.
  template <class T>
  [[nodiscard]] std::vector<T> read(const Json& accessor,
                                    std::optional<Bytes> packed = std::nullopt) const;
  /// The application's own attributes (leading underscore) of one number per vertex.
  [[nodiscard]] std::vector<NamedScalars> scalars() const;
  /// Indices of vertices. Empty if the primitive has none.
  [[nodiscard]] std::vector<std::uint32_t> indices() const;

 private:
  const Json& primitive_;
  Json accessors_;
  Buffers& buffers_;
  std::size_t vertices_ = 0;
  std::optional<Unpacked> unpacked_;
};
extern template std::vector<float> PrimitiveData::read(const std::string&) const;
extern template std::vector<Vec2> PrimitiveData::read(const std::string&) const;
extern template std::vector<Vec3> PrimitiveData::read(const std::string&) const;
extern template std::vector<Vec4> PrimitiveData::read(const std::string&) const;
extern template std::vector<Vec3> PrimitiveData::read(const Json&, std::optional<Bytes>) const;

/// A primitive as a mesh; none, with a warning, without a whole triangle. `use`: where its
/// material's textures read. Does not set Mesh::material.
[[nodiscard]] std::optional<Mesh> read_primitive(const Json& primitive, const PrimitiveData& data,
                                                 const TextureUse& use,
                                                 std::vector<std::string>& warnings);

/// A primitive of points or lines; none, with a warning, if empty. Does not set its material.
[[nodiscard]] std::optional<Geometry> read_points_or_lines(const Json& primitive,
                                                           const PrimitiveData& data,
                                                           std::vector<std::string>& warnings);

/// Reads what moves the vertices of `mesh`, which comes from a primitive of the document's `owner`;
/// null: nothing does.
[[nodiscard]] std::shared_ptr<const Rig::Shape> read_shape(const Json& primitive,
                                                           const PrimitiveData& data,
                                                           const Json& document, const Json& owner,
                                                           const Mesh& mesh);
/// The document's nodes and skins, in its numbering, and its animations.
void read_nodes(const Json& document, Rig& rig);
/// Adds a node for each instance of EXT_mesh_gpu_instancing, after the document's nodes and below
/// the node that has the extension. Returns the first and the number of them, by that node.
[[nodiscard]] std::map<std::size_t, std::pair<std::uint32_t, std::uint32_t>> read_instancing(
    const Json& document, Buffers& buffers, Rig& rig);
void read_skins(const Json& document, Buffers& buffers, Rig& rig);
[[nodiscard]] std::vector<Animation> read_animations(const Json& document, Buffers& buffers,
                                                     Rig& rig, std::vector<std::string>& warnings);

}  // namespace rastrum::io::gltf
