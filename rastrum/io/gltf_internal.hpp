// SPDX-License-Identifier: BSD-3-Clause
// Declarations that the parts of the glTF reader share; see gltf.cpp for the way through them.
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

/// Checks every reference, range, length and offset of the document, used or not, before anything
/// is read. Throws Error{bad_format | unsupported}; appends warnings.
void check(const Json& document, std::vector<std::string>& warnings);

/// Values of componentType.
constexpr std::size_t kByte = 5120, kUbyte = 5121, kShort = 5122, kUshort = 5123, kUint = 5125,
                      kFloat = 5126;
/// Calls f with a value of the type that one of them names.
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

/// componentType and type of an accessor. `components` is 0 for a type that is not known.
struct AccessorType {
  std::size_t component_type = 0, component_bytes = 0, components = 0;
  std::size_t element_bytes = 0;  ///< with the padding of matrix columns
  std::size_t used_bytes = 0;     ///< without the padding of the last column
};
[[nodiscard]] AccessorType accessor_type(const Json& accessor);
/// The type of sparse indices and the like. Throws unless 5120 to 5126 without 5124.
[[nodiscard]] std::size_t component_bytes(const Json& component_type);

/// Extensions that pack bytes, each by a library that may have been missing at build time; then
/// what there is without it is read: buffers and accessors that hold the same unpacked.
constexpr const char* kMeshopt = "EXT_meshopt_compression";
constexpr const char* kDraco = "KHR_draco_mesh_compression";
/// Others that several parts read.
constexpr const char* kInstancing = "EXT_mesh_gpu_instancing";
constexpr const char* kSpecularGlossiness = "KHR_materials_pbrSpecularGlossiness";
constexpr const char* kWebp = "EXT_texture_webp";
constexpr const char* kBasisu = "KHR_texture_basisu";
[[nodiscard]] bool has_meshopt();
[[nodiscard]] bool has_draco();

/// `view` has the extension: what it says of itself must be of one size and kind.
void check_meshopt(const Json& view, const Json& extension);
/// The bytes of such a view, of which `packed` are the extension's. Checked before.
/// Throws Error{bad_format}; Error{unsupported} without the library.
[[nodiscard]] std::vector<std::byte> decode_meshopt(const Json& extension, Bytes packed);

/// Data that Draco had packed: vertices in the types of their accessors, without gaps.
struct Unpacked {
  std::map<std::string, std::vector<std::byte>> attributes;
  std::vector<std::uint32_t> indices;
};
/// `packed`: the bytes of the extension's view. Throws as decode_meshopt.
[[nodiscard]] Unpacked decode_draco(const Json& primitive, const Json& extension,
                                    const Json& document, Bytes packed);

/// Lights of KHR_lights_punctual, unplaced: at the origin, along −z; none: of a kind that is
/// not known. Throws Error{bad_format}.
[[nodiscard]] std::vector<std::optional<Light>> read_lights(const Json& document);
/// Which of so many a node places; none: it has none. Throws likewise.
[[nodiscard]] std::optional<std::size_t> light_of_node(const Json& node, std::size_t lights);

/// Bytes of buffers, read when they are asked for.
class Buffers {
 public:
  Buffers(const Json& document, Reading& reading, std::optional<Bytes> glb_chunk)
      : document_(document), reading_(reading), glb_chunk_(glb_chunk) {}

  /// Arrays that are made of the bytes take their memory from it.
  [[nodiscard]] Budget& budget() { return reading_.budget; }

  /// The bytes of a buffer view, unpacked; nullopt where the buffer has none (no uri: an
  /// application's own).
  [[nodiscard]] std::optional<Bytes> view(std::size_t index);
  /// The bytes behind a URI: data: or a file beside this one. `where` names it in errors.
  [[nodiscard]] Bytes uri(const std::string& uri, const Json& where);

  /// Whether an accessor holds more than the zeros that stand for bytes which are not there.
  [[nodiscard]] bool has_bytes(const Json& accessor);
  /// Elements of an accessor as floats, `components` each; integers are normalized where the
  /// accessor says so. Sparse values are put in. `packed`: its elements, in the place of those that
  /// it refers to.
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

/// The affine map of KHR_texture_transform and the set of texture coordinates it applies to.
struct TextureUse {
  std::size_t set = 0;
  float m[2][3] = {{1, 0, 0}, {0, 1, 0}};
  friend bool operator==(const TextureUse&, const TextureUse&) = default;
};

/// Materials and their textures, converted when a primitive first uses them.
class Materials {
 public:
  Materials(const Json& document, Buffers& buffers, Scene& scene);

  /// The index in Scene::materials for a primitive's material, or for none.
  std::uint32_t use(std::optional<std::size_t> material);
  /// Where this material's textures read the mesh.
  [[nodiscard]] TextureUse texture_use(std::optional<std::size_t> material) const;
  /// Fills the textures, once all materials are converted. One that cannot be read is taken out of
  /// the scene, with a warning.
  void decode_images();

 private:
  /// A material of specular colour and glossiness, which is converted once its pictures are read.
  struct Glossy {
    std::size_t material = 0;
    Vec4 diffuse{1, 1, 1, 1};
    Vec3 specular{1, 1, 1};
    float glossiness = 1;
    std::int32_t texture = kNoTexture;  ///< specular colour, and glossiness as alpha
  };
  void convert(std::size_t index);
  void convert_glossy(std::size_t index, const Json& extension, const TextureUse& expected,
                      Material& to);
  void finish(const Glossy& glossy);
  std::int32_t texture(const Json& owner, const char* key, const TextureUse& expected);
  std::int32_t load_texture(std::size_t index);
  /// The picture of an image. None, and a warning, if it cannot be read.
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
/// Whether it is of points or lines (modes 0 to 3), not of triangles.
[[nodiscard]] bool is_points_or_lines(const Json& primitive);

/// The attributes and indices of a primitive, wherever its file keeps them.
class PrimitiveData {
 public:
  /// The primitive has positions.
  PrimitiveData(const Json& primitive, const Json& document, Buffers& buffers);

  [[nodiscard]] std::size_t vertices() const { return vertices_; }
  [[nodiscard]] Budget& budget() const { return buffers_.budget(); }
  /// The accessor of an attribute, if the primitive has it.
  [[nodiscard]] std::optional<Json> attribute(const std::string& name) const;
  /// Reads vectors of floats, one a vertex; colours of three components get alpha 1. `name`: an
  /// attribute that the primitive has.
  template <class T>
  [[nodiscard]] std::vector<T> read(const std::string& name) const;
  /// The same of an accessor beside its attributes; `packed`: as for Buffers::floats.
  template <class T>
  [[nodiscard]] std::vector<T> read(const Json& accessor,
                                    std::optional<Bytes> packed = std::nullopt) const;
  /// The attributes that an application has added, whose names begin with an underscore: those of
  /// one number a vertex.
  [[nodiscard]] std::vector<NamedScalars> scalars() const;
  /// Empty where the primitive has none; each is a vertex.
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

/// One primitive as a mesh; nullopt, with a warning, where it holds no whole triangle.
/// Mesh::material is left alone, `use` says where the material's textures read.
[[nodiscard]] std::optional<Mesh> read_primitive(const Json& primitive, const PrimitiveData& data,
                                                 const TextureUse& use,
                                                 std::vector<std::string>& warnings);

/// One of points or lines; nullopt, with a warning, where it holds none. Its material is left
/// alone.
[[nodiscard]] std::optional<Geometry> read_points_or_lines(const Json& primitive,
                                                           const PrimitiveData& data,
                                                           std::vector<std::string>& warnings);

/// Reads what moves the vertices of `mesh`, which was read from a primitive of the document's
/// `owner`; null: nothing does.
[[nodiscard]] std::shared_ptr<const Rig::Shape> read_shape(const Json& primitive,
                                                           const PrimitiveData& data,
                                                           const Json& document, const Json& owner,
                                                           const Mesh& mesh);
/// The document's nodes and skins, in its numbering, and its animations.
void read_nodes(const Json& document, Rig& rig);
/// Adds a node for each instance of EXT_mesh_gpu_instancing behind the document's nodes, below the
/// node that has it. Returns the first and the number of them, by that node.
[[nodiscard]] std::map<std::size_t, std::pair<std::uint32_t, std::uint32_t>> read_instancing(
    const Json& document, Buffers& buffers, Rig& rig);
void read_skins(const Json& document, Buffers& buffers, Rig& rig);
[[nodiscard]] std::vector<Animation> read_animations(const Json& document, Buffers& buffers,
                                                     Rig& rig, std::vector<std::string>& warnings);

}  // namespace rastrum::io::gltf
