// SPDX-License-Identifier: BSD-3-Clause
// GLB out of core: meshes of indexed triangle lists at the scene's nodes, with materials and
// textures. A selection is a GLB with the same JSON, whose accessors of vertices and indices have
// what was selected. Nodes that share a mesh share what any of them has.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include <rastrum/io/glb.hpp>
#include <rastrum/io/large_indexed.hpp>

namespace rastrum::io {
namespace {

using nlohmann::json;

constexpr std::size_t kFloat = 5126, kUint = 5125, kUshort = 5123;

/// The deepest nesting of arrays and objects.
constexpr std::size_t kDeepest = 1000;
/// How deep a JSON text nests and how much memory its document takes, before it is parsed.
struct JsonCost {
  std::size_t depth = 0;
  std::uint64_t bytes = 0;  ///< rather too many; of nlohmann::json with glibc's allocator
};
JsonCost cost_of(std::string_view text) {
  constexpr std::uint64_t kValue = 16, kObject = 64, kMember = 96, kString = 48, kArray = 80;
  constexpr std::size_t kShort = 15;  // characters that lie in a string itself
  JsonCost cost{0, kValue};
  std::vector<bool> in_array;
  for (std::size_t i = 0; i < text.size(); ++i) {
    switch (text[i]) {
      case '"': {
        const std::size_t begin = i;
        while (++i < text.size() && text[i] != '"')
          if (text[i] == '\\') ++i;
        cost.bytes += kString + (i - begin > kShort ? i - begin + kValue : 0);
        break;
      }
      case '[':
      case '{':
        in_array.push_back(text[i] == '[');
        cost.depth = std::max(cost.depth, in_array.size());
        if (cost.depth > kDeepest) return cost;
        cost.bytes += text[i] == '[' ? kArray : kObject;
        break;
      case ']':
      case '}':
        if (!in_array.empty()) in_array.pop_back();
        break;
      // The string before it is a name, which lies in the member.
      case ':':
        cost.bytes += kMember - kString;
        break;
      // An array that grows has room for twice as many.
      case ',':
        if (!in_array.empty() && in_array.back()) cost.bytes += 2 * kValue;
        break;
      default:
        break;
    }
  }
  return cost;
}

std::size_t components(const std::string& type) {
  if (type == "SCALAR") return 1;
  return type.size() == 4 && type.starts_with("VEC") ? static_cast<std::size_t>(type[3] - '0') : 0U;
}

class LargeGlb final : public LargeIndexed {
 public:
  LargeGlb(const std::filesystem::path& file, std::uint64_t memory_limit) : LargeIndexed(file) {
    read_json(memory_limit);
    try {
      look_at_scene();
    } catch (const json::exception& e) {
      fail(std::string("its JSON is not that of a glTF file: ").append(e.what()));
    }
  }

  [[nodiscard]] bool has_normals() const override {
    return std::ranges::all_of(primitives_,
                               [](const Primitive& p) { return p.attributes.contains("NORMAL"); });
  }
  [[nodiscard]] bool has_materials() const override { return json_.contains("materials"); }
  [[nodiscard]] std::uint64_t bytes_in_memory() const override {
    std::uint64_t bytes = 0;
    for (std::size_t k = 0; k < meshes_.size(); ++k)
      bytes += meshes_[k].triangles * 12 + meshes_[k].vertices * primitives_[k].bytes_in_memory();
    return bytes;
  }
  [[nodiscard]] std::uint64_t bytes_beside() const override { return bytes_beside_; }
  [[nodiscard]] std::uint64_t bytes_a_triangle() const override {
    std::uint64_t most = 0;
    for (const Primitive& p : primitives_) most = std::max(most, p.bytes_in_memory());
    return 24 + 3 * 2 * most;
  }

  [[nodiscard]] FileSelection selection(std::span<const std::uint64_t> triangles) const override {
    check_length();
    FileSelection small;
    small.meshes = of_meshes(triangles);
    std::uint64_t id = 0;
    for (std::size_t part = 0; part < parts_.size(); ++part) {
      small.parts.push_back({id, parts_[part].first, mesh_of(part)});
      id += small.meshes[mesh_of(part)].size();
    }
    json doc = json_;
    std::vector<std::byte> bin;
    json views = json::array(), accessors = json::array();
    const auto begin_view = [&](std::size_t bytes) {
      bin.resize((bin.size() + 3) / 4 * 4);
      views.push_back({{"buffer", 0}, {"byteOffset", bin.size()}, {"byteLength", bytes}});
      bin.resize(bin.size() + bytes);
      return bin.data() + bin.size() - bytes;
    };
    for (std::size_t k = 0; k < meshes_.size(); ++k) {
      const IndexedPlace& mesh = meshes_[k];
      const Primitive& of = primitives_[k];
      json& primitive = doc["meshes"][of.mesh]["primitives"][of.number];
      std::vector<std::uint32_t> indices(3 * small.meshes[k].size());
      std::uint32_t low = ~std::uint32_t{0}, high = 0;
      {
        WalkWindow window(mapped(), mesh.first_face);
        std::uint32_t* to = indices.data();
        for (const std::uint64_t t : small.meshes[k]) {
          window.reach(mesh.face_at(t));
          copy_indices(mesh, t, 1, to, low, high);
          to += 3;
        }
      }
      VertexSet used(mesh.vertices);
      for (const std::uint32_t i : indices) used.add(i);
      const std::size_t n = used.find_places();
      for (const auto& entry : of.attributes) {
        const Attribute& a = entry.second;
        const std::size_t padded = (a.bytes + 3) / 4 * 4;  // elements of vertices are aligned
        std::byte* to = begin_view(n * padded);
        WalkWindow window(mapped(), a.offset);
        used.for_each([&](std::size_t v) {
          window.reach(a.offset + v * a.stride);
          std::memcpy(to, bytes_of_file().data() + a.offset + v * a.stride, a.bytes);
          to += padded;
        });
        views.back()["byteStride"] = padded;
        json accessor = json_["accessors"][a.accessor];
        accessor["bufferView"] = views.size() - 1;
        accessor["byteOffset"] = 0;
        accessor["count"] = n;
        primitive["attributes"][entry.first] = accessors.size();
        accessors.push_back(std::move(accessor));
      }
      std::byte* to = begin_view(indices.size() * 4);
      for (std::uint32_t& i : indices) i = used.place(i);
      std::memcpy(to, indices.data(), indices.size() * 4);
      primitive["indices"] = accessors.size();
      accessors.push_back({{"bufferView", views.size() - 1},
                           {"componentType", kUint},
                           {"count", indices.size()},
                           {"type", "SCALAR"}});
    }
    if (doc.contains("images"))
      for (json& image : doc["images"])
        if (image.contains("bufferView")) {
          const auto [offset, bytes] = view(image["bufferView"].get<std::size_t>());
          std::byte* const pixels = begin_view(bytes);
          std::memcpy(pixels, bytes_of_file().data() + offset, bytes);
          image["bufferView"] = views.size() - 1;
        }
    doc["accessors"] = std::move(accessors);
    doc["bufferViews"] = std::move(views);
    bin.resize((bin.size() + 3) / 4 * 4);
    doc["buffers"] = json::array({{{"byteLength", bin.size()}}});
    small.file = glb_of(doc.dump(), bin);
    return small;
  }

 private:
  struct Attribute {
    std::size_t accessor, offset, stride, bytes;
  };
  /// Its place in the file is in meshes_, under the same index.
  struct Primitive {
    std::size_t mesh, number;
    std::map<std::string, Attribute> attributes{};
    [[nodiscard]] std::uint64_t bytes_in_memory() const {
      std::uint64_t bytes = 0;
      for (const auto& [name, a] : attributes) bytes += name.starts_with("COLOR") ? 16U : 12U;
      return bytes;
    }
  };

  /// For each mesh its triangles, rising, that some part has among `triangles`; at least the first.
  [[nodiscard]] std::vector<std::vector<std::uint64_t>> of_meshes(
      std::span<const std::uint64_t> triangles) const {
    std::vector<std::vector<std::uint64_t>> all(meshes_.size());
    auto at = triangles.begin();
    for (std::size_t part = 0; part < parts_.size(); ++part) {
      std::vector<std::uint64_t>& list = all[mesh_of(part)];
      const auto end =
          std::lower_bound(at, triangles.end(), parts_[part].first + parts_[part].count);
      for (; at != end; ++at) list.push_back(*at - parts_[part].first);
    }
    for (std::vector<std::uint64_t>& list : all) {
      std::sort(list.begin(), list.end());
      list.erase(std::unique(list.begin(), list.end()), list.end());
      if (list.empty()) list.push_back(0);
    }
    return all;
  }

  void copy_indices(const IndexedPlace& mesh, std::uint64_t first, std::size_t n, std::uint32_t* to,
                    std::uint32_t& lowest, std::uint32_t& highest) const override {
    const std::byte* from = bytes_of_file().data() + mesh.face_at(first);
    if (mesh.face_bytes == 12)
      std::memcpy(to, from, 12 * n);
    else
      for (std::size_t i = 0; i < 3 * n; ++i) {
        std::uint16_t index = 0;
        std::memcpy(&index, from + 2 * i, sizeof(index));
        to[i] = index;
      }
    for (std::size_t i = 0; i < 3 * n; ++i) {
      lowest = std::min(lowest, to[i]);
      highest = std::max(highest, to[i]);
    }
    if (highest < mesh.vertices) return;
    for (std::size_t i = 0; i < 3 * n; ++i)
      if (to[i] >= mesh.vertices) refuse_index(mesh, first + i / 3, to[i]);
  }

  void read_json(std::uint64_t memory_limit) {
    const Bytes bytes = bytes_of_file();
    if (!is_glb(bytes)) refuse("it is not a GLB; a .gltf is read whole");
    const Glb glb = open_glb(bytes, name_);
    if (!glb.bin) refuse("it has no binary chunk");
    bin_ = static_cast<std::size_t>(glb.bin->data() - bytes.data());
    bin_bytes_ = glb.bin->size();
    // The parser does not recurse, but copying and printing do.
    const JsonCost cost = cost_of(glb.text);
    if (cost.depth > kDeepest) fail("its JSON is nested too deep");
    // Two documents (the file's, and a selection's or the reader's) and a selection's texts, of
    // which one grows.
    bytes_beside_ = 2 * cost.bytes + 3 * glb.text.size();
    const auto check_memory = [&](const char* what) {
      if (bytes_beside_ > memory_limit)
        throw Error(Errc::out_of_memory, name_ + ": out of core: " + what + " about " +
                                             std::to_string(bytes_beside_) +
                                             " bytes of memory, and the memory limit is " +
                                             std::to_string(memory_limit));
    };
    check_memory("its JSON alone takes");
    json_ = json::parse(glb.text, nullptr, false);
    if (json_.is_discarded()) fail("its JSON cannot be read");
    mapped().drop(kGlbHeader + kGlbChunk, glb.text.size());
    constexpr std::uint64_t kNode = 512;  // bytes: the reader's node and its place
    if (const auto nodes = json_.find("nodes"); nodes != json_.end())
      bytes_beside_ += kNode * nodes->size();
    check_memory("its nodes and JSON take");
  }

  void look_at_scene() {
    require(!json_.contains("extensionsRequired"), "it requires extensions");
    require(!json_.contains("skins") && !json_.contains("animations"), "it moves");
    for (const json& m : json_.value("materials", json::array()))
      require(m.value("alphaMode", "OPAQUE") != "MASK", "its material is masked");
    const json& meshes = json_.at("meshes");
    std::vector<std::size_t> first_primitive;
    for (std::size_t m = 0; m < meshes.size(); ++m) {
      first_primitive.push_back(meshes_.size());
      for (std::size_t k = 0; k < meshes[m].at("primitives").size(); ++k) look_at_primitive(m, k);
    }
    first_primitive.push_back(meshes_.size());
    if (meshes_.size() == 1) meshes_[0].name.clear();
    for (const std::size_t m : meshes_of_nodes()) {
      if (m >= meshes.size())
        fail("a node has mesh " + std::to_string(m) + " of " + std::to_string(meshes.size()));
      for (std::size_t k = first_primitive[m]; k < first_primitive[m + 1]; ++k) {
        parts_.push_back({triangles_, meshes_[k].triangles});
        mesh_of_part_.push_back(k);
        triangles_ += meshes_[k].triangles;
      }
    }
    require(!parts_.empty(), "no node of its scene has a mesh");
    std::vector<bool> drawn(meshes_.size());
    for (const std::size_t k : mesh_of_part_) drawn[k] = true;
    for (std::size_t k = 0; k < meshes_.size(); ++k)
      if (!drawn[k]) check_indices(meshes_[k]);
    for (const json& image : json_.value("images", json::array()))
      if (image.contains("bufferView")) (void)view(whole_of(image, "bufferView"));
  }

  /// Checks a mesh that no node draws, as the reader does.
  void check_indices(const IndexedPlace& mesh) const {
    WalkWindow window(mapped(), mesh.first_face);
    std::vector<std::uint32_t> indices(3 * kAtOnce);
    std::uint32_t low = 0, high = 0;
    for (std::uint64_t t = 0; t < mesh.triangles; t += kAtOnce) {
      const auto n = static_cast<std::size_t>(std::min<std::uint64_t>(kAtOnce, mesh.triangles - t));
      copy_indices(mesh, t, n, indices.data(), low, high);
      window.reach(mesh.face_at(t + n));
    }
  }

  void require(bool ok, const std::string& what) const {
    if (!ok) refuse(what);
  }

  /// As in gltf_json.hpp: JSON may write whole numbers as 1.0 or 1e0, and the parser makes those
  /// beyond 64 bits float64.
  [[nodiscard]] std::size_t whole(const json& number, const char* what) const {
    if (number.is_number_unsigned()) return number.get<std::size_t>();
    const double x = number.is_number() ? number.get<double>() : -1;
    if (!(x >= 0 && x <= 9007199254740992.0) || x != std::floor(x))
      fail(std::string(what).append(" must be a whole number that is not negative"));
    return static_cast<std::size_t>(x);
  }
  [[nodiscard]] std::size_t whole_of(const json& object, const char* key) const {
    return whole(object.at(key), key);
  }
  [[nodiscard]] std::size_t whole_or(const json& object, const char* key,
                                     std::size_t otherwise) const {
    return object.contains(key) ? whole(object[key], key) : otherwise;
  }

  void look_at_primitive(std::size_t m, std::size_t k) {
    const json& primitive = json_["meshes"][m]["primitives"][k];
    IndexedPlace mesh;
    mesh.name = "meshes[" + std::to_string(m) + "].primitives[" + std::to_string(k) + "]: ";
    const std::string where = json_["meshes"].size() == 1 && k == 0 ? "" : mesh.name;
    require(whole_or(primitive, "mode", 4) == 4, where + "it is no list of triangles");
    require(!primitive.contains("targets") && !primitive.contains("extensions"),
            where + "it moves, or is packed");
    require(primitive.contains("indices"), where + "it has no indices");
    Primitive of{m, k};
    for (const auto& [name, accessor] : primitive.at("attributes").items())
      of.attributes[name] = place(whole(accessor, name.c_str()));
    require(of.attributes.contains("POSITION"), where + "it has no positions");
    const Attribute& p = of.attributes["POSITION"];
    const json& positions = json_["accessors"][p.accessor];
    require(positions.at("componentType") == kFloat && positions.at("type") == "VEC3",
            where + "its positions are not float32");
    mesh.vertices = whole_of(positions, "count");
    require(mesh.vertices <= std::numeric_limits<std::uint32_t>::max(),
            where + "it has more than 2³² vertices");
    for (const auto& [name, a] : of.attributes)
      if (whole_of(json_["accessors"][a.accessor], "count") != mesh.vertices)
        fail(where + "its attributes are not equally many");
    require(!of.attributes.contains("COLOR_0") || json_.contains("materials"),
            where + "it has colours and no material");
    mesh.first_vertex = p.offset;
    mesh.vertex_bytes = p.stride;
    const Attribute i = place(whole_of(primitive, "indices"));
    const json& indices = json_["accessors"][i.accessor];
    const std::size_t type = whole_of(indices, "componentType");
    require((type == kUint || type == kUshort) && i.stride == i.bytes,
            where + "its indices are not of 16 or 32 bits side by side");
    const std::uint64_t count = whole_of(indices, "count");
    require(count >= 3 && count % 3 == 0, where + "its indices are no whole triangles");
    mesh.triangles = count / 3;
    mesh.first_face = i.offset;
    mesh.face_bytes = 3 * i.bytes;
    vertices_ += mesh.vertices;
    meshes_.push_back(std::move(mesh));
    primitives_.push_back(std::move(of));
  }

  /// In the reader's order: depth first from the roots of the scene.
  [[nodiscard]] std::vector<std::size_t> meshes_of_nodes() const {
    const json nothing = json::array();  // a document may have none
    const json& nodes = json_.contains("nodes") ? json_.at("nodes") : nothing;
    std::vector<std::size_t> stack;
    if (const json scenes = json_.value("scenes", json::array()); !scenes.empty()) {
      const json& scene = scenes.at(whole_or(json_, "scene", 0));
      for (const json& n : scene.value("nodes", json::array()))
        stack.push_back(whole(n, "a node of its scene"));
    } else {
      std::vector<bool> child(nodes.size());
      for (const json& node : nodes)
        for (const json& c : node.value("children", json::array()))
          if (const std::size_t n = whole(c, "a child"); n < child.size()) child[n] = true;
      for (std::size_t n = 0; n < nodes.size(); ++n)
        if (!child[n]) stack.push_back(n);
    }
    std::ranges::reverse(stack);
    std::vector<bool> seen(nodes.size());
    std::vector<std::size_t> meshes;
    while (!stack.empty()) {
      const std::size_t n = stack.back();
      stack.pop_back();
      if (n >= nodes.size())
        fail("its scene has node " + std::to_string(n) + " of " + std::to_string(nodes.size()));
      if (seen[n]) fail("node " + std::to_string(n) + " is reached twice");
      seen[n] = true;
      const json& node = nodes[n];
      const std::string where = "nodes[" + std::to_string(n) + "]: ";
      if (node.contains("extensions"))
        for (const char* const name : {"KHR_node_visibility", "EXT_mesh_gpu_instancing"})
          require(!node["extensions"].contains(name), where + "it has " + name);
      require(!node.contains("skin") && !node.contains("weights"), where + "it moves");
      if (node.contains("mesh")) meshes.push_back(whole_of(node, "mesh"));
      const json children = node.value("children", json::array());
      for (std::size_t c = children.size(); c-- > 0;)
        stack.push_back(whole(children[c], "a child"));
    }
    return meshes;
  }

  [[nodiscard]] std::pair<std::size_t, std::size_t> view(std::size_t number) const {
    const json& v = json_.at("bufferViews").at(number);
    if (v.contains("extensions")) refuse("its buffers are packed");
    const std::size_t offset = whole_or(v, "byteOffset", 0);
    const std::size_t length = whole_of(v, "byteLength");
    const json& buffer = json_.at("buffers").at(0);
    if (whole_of(v, "buffer") != 0 || buffer.contains("uri"))
      refuse("its data lie in another file");
    const std::size_t bytes = whole_of(buffer, "byteLength");
    if (bytes > bin_bytes_) fail("its buffer reaches beyond the binary chunk");
    if (offset > bytes || length > bytes - offset)
      fail("buffer view " + std::to_string(number) + " reaches beyond its buffer");
    return {bin_ + offset, length};
  }

  [[nodiscard]] Attribute place(std::size_t number) const {
    const json& a = json_.at("accessors").at(number);
    if (a.contains("sparse") || !a.contains("bufferView")) refuse("an accessor is sparse");
    const std::size_t of_view = whole_of(a, "bufferView");
    const auto [offset, length] = view(of_view);
    const std::size_t type = whole_of(a, "componentType");
    const std::size_t each = type == kFloat || type == kUint   ? 4
                             : type == kUshort || type == 5122 ? 2
                                                               : 1;
    const std::size_t bytes = each * components(a.at("type").get<std::string>());
    if (bytes == 0) refuse("an accessor holds matrices");
    const std::size_t inside = whole_or(a, "byteOffset", 0);
    const std::size_t stride = whole_or(json_["bufferViews"][of_view], "byteStride", bytes);
    const std::uint64_t count = whole_of(a, "count");
    if (stride < bytes || count == 0 || inside > length || length - inside < bytes ||
        count - 1 > (length - inside - bytes) / stride)
      fail("accessor " + std::to_string(number) + " reaches beyond its buffer view");
    return {number, offset + inside, stride, bytes};
  }

  [[nodiscard]] std::vector<std::byte> glb_of(std::string text,
                                              std::span<const std::byte> bin) const {
    text.resize((text.size() + 3) / 4 * 4, ' ');
    if (kGlbHeader + 2 * kGlbChunk + text.size() + bin.size() >
        std::numeric_limits<std::uint32_t>::max())
      refuse(
          "the part that is drawn at once has more than 4 GiB; with a lower memory limit the parts "
          "are smaller");
    std::vector<std::byte> out;
    const auto put = [&](const void* from, std::size_t n) {
      const auto* const bytes = static_cast<const std::byte*>(from);
      out.insert(out.end(), bytes, bytes + n);
    };
    const auto put_u32 = [&](std::size_t v) {
      const auto narrow = static_cast<std::uint32_t>(v);
      put(&narrow, sizeof(narrow));
    };
    out.reserve(kGlbHeader + 2 * kGlbChunk + text.size() + bin.size());
    put("glTF", 4);
    put_u32(2);
    put_u32(kGlbHeader + 2 * kGlbChunk + text.size() + bin.size());
    put_u32(text.size());
    put_u32(kJsonChunk);
    put(text.data(), text.size());
    put_u32(bin.size());
    put_u32(kBinChunk);
    put(bin.data(), bin.size());
    return out;
  }

  json json_;
  std::uint64_t bytes_beside_ = 0;
  std::size_t bin_ = 0, bin_bytes_ = 0;
  std::vector<Primitive> primitives_;
};

}  // namespace

std::unique_ptr<LargeFile> open_large_glb(const std::filesystem::path& file,
                                          std::uint64_t memory_limit) {
  return std::make_unique<LargeGlb>(file, memory_limit);
}

}  // namespace rastrum::io
