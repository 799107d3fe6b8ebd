// GLB out of core: one mesh of one list of indexed triangles, at one node, with its material and
// textures. A selection is a GLB with the same JSON, whose accessors of vertices and indices are of
// what was selected.
#include <algorithm>
#include <cstring>
#include <map>
#include <string>
#include <utility>

#include <nlohmann/json.hpp>

#include <rastrum/io/large_indexed.hpp>

namespace rastrum::io {
namespace {

using nlohmann::json;

constexpr std::size_t kGlbHeader = 12, kGlbChunk = 8;
constexpr std::uint32_t kJsonChunk = 0x4E4F534A, kBinChunk = 0x004E4942;
constexpr int kFloat = 5126, kUint = 5125, kUshort = 5123;

std::uint32_t u32_at(Bytes bytes, std::size_t at) {
  std::uint32_t v = 0;
  std::memcpy(&v, bytes.data() + at, sizeof(v));
  return v;
}

std::size_t components(const std::string& type) {
  if (type == "SCALAR") return 1;
  return type.size() == 4 && type.starts_with("VEC") ? static_cast<std::size_t>(type[3] - '0') : 0U;
}

class LargeGlb final : public LargeIndexed {
 public:
  explicit LargeGlb(const std::filesystem::path& file) : LargeIndexed(file) {
    read_json();
    try {
      look_at_scene();
    } catch (const json::exception& e) {
      fail(std::string("its JSON is not as glTF has it: ").append(e.what()));
    }
  }

  [[nodiscard]] std::string_view format() const override { return "glb"; }
  [[nodiscard]] bool has_normals() const override { return attributes_.contains("NORMAL"); }
  [[nodiscard]] bool has_materials() const override { return json_.contains("materials"); }
  [[nodiscard]] std::uint64_t bytes_in_memory() const override {
    return triangles_ * 12 + vertices_ * vertex_in_memory();
  }
  [[nodiscard]] std::uint64_t bytes_a_triangle() const override {
    return 24 + 3 * 2 * vertex_in_memory();
  }

  [[nodiscard]] std::vector<std::byte> selection(
      std::span<const std::uint64_t> triangles) const override {
    check_length();
    VertexSet used(vertices_);
    std::vector<std::uint32_t> indices(3 * triangles.size());
    std::uint32_t low = ~std::uint32_t{0}, high = 0;
    {
      WalkWindow window(mapped(), first_face_);
      for (std::size_t i = 0; i < triangles.size(); ++i) {
        window.reach(face_at(triangles[i]));
        copy_indices(triangles[i], 1, indices.data() + 3 * i, low, high);
      }
    }
    for (const std::uint32_t i : indices) used.add(i);
    const std::size_t n = used.count();

    json doc = json_;
    std::vector<std::byte> bin;
    json views = json::array(), accessors = json::array();
    const auto begin_view = [&](std::size_t bytes) {
      bin.resize((bin.size() + 3) / 4 * 4);
      views.push_back({{"buffer", 0}, {"byteOffset", bin.size()}, {"byteLength", bytes}});
      bin.resize(bin.size() + bytes);
      return bin.data() + bin.size() - bytes;
    };
    json& primitive = doc["meshes"][0]["primitives"][0];
    for (const auto& entry : attributes_) {
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
    return glb_of(doc.dump(), bin);
  }

 private:
  struct Attribute {
    std::size_t accessor, offset, stride, bytes;
  };

  void copy_indices(std::uint64_t first, std::size_t n, std::uint32_t* to, std::uint32_t& lowest,
                    std::uint32_t& highest) const override {
    const std::byte* from = bytes_of_file().data() + face_at(first);
    if (face_bytes_ == 12)
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
    if (highest < vertices_) return;
    for (std::size_t i = 0; i < 3 * n; ++i)
      if (to[i] >= vertices_) refuse_index(first + i / 3, to[i]);
  }

  [[nodiscard]] std::uint64_t vertex_in_memory() const {
    std::uint64_t bytes = 0;
    for (const auto& [name, a] : attributes_) bytes += name.starts_with("COLOR") ? 16U : 12U;
    return bytes;
  }

  void read_json() {
    const Bytes bytes = bytes_of_file();
    if (!as_text(bytes).starts_with("glTF"))
      refuse("it is no GLB; .gltf with files beside is read");
    if (bytes.size() < kGlbHeader + kGlbChunk) fail("the file ends inside of its header");
    const std::size_t length = u32_at(bytes, kGlbHeader);
    if (u32_at(bytes, kGlbHeader + 4) != kJsonChunk ||
        length > bytes.size() - kGlbHeader - kGlbChunk)
      fail("the file ends inside of its JSON");
    const std::string_view text = as_text(bytes.subspan(kGlbHeader + kGlbChunk, length));
    json_ = json::parse(text, nullptr, false);
    if (json_.is_discarded()) fail("its JSON cannot be read");
    const std::size_t next = kGlbHeader + kGlbChunk + length;
    if (bytes.size() - next < kGlbChunk || u32_at(bytes, next + 4) != kBinChunk)
      refuse("it has no binary chunk");
    bin_ = next + kGlbChunk;
    bin_bytes_ = u32_at(bytes, next);
    if (bin_bytes_ > bytes.size() - bin_) fail("the file ends inside of its binary chunk");
  }

  void look_at_scene() {
    const auto require = [&](bool ok, const char* what) {
      if (!ok) refuse(what);
    };
    require(!json_.contains("extensionsRequired"), "it requires extensions");
    require(!json_.contains("skins") && !json_.contains("animations"), "it moves");
    require(json_.at("meshes").size() == 1 && json_["meshes"][0].at("primitives").size() == 1,
            "it is not one mesh of one primitive");
    std::size_t users = 0;
    for (const json& node : json_.at("nodes")) users += node.contains("mesh") ? 1U : 0U;
    require(users == 1, "its mesh is not at one node");
    const json& primitive = json_["meshes"][0]["primitives"][0];
    require(primitive.value("mode", 4) == 4, "it is no list of triangles");
    require(!primitive.contains("targets") && !primitive.contains("extensions"), "it moves");
    require(primitive.contains("indices"), "it has no indices");
    for (const json& m : json_.value("materials", json::array()))
      require(m.value("alphaMode", "OPAQUE") != "MASK", "its material is masked");
    for (const auto& [name, accessor] : primitive.at("attributes").items())
      attributes_[name] = place(accessor.get<std::size_t>());
    require(attributes_.contains("POSITION"), "it has no positions");
    const Attribute& p = attributes_["POSITION"];
    const json& positions = json_["accessors"][p.accessor];
    require(positions.at("componentType") == kFloat && positions.at("type") == "VEC3",
            "its positions are not float32");
    vertices_ = positions.at("count").get<std::uint64_t>();
    for (const auto& [name, a] : attributes_)
      if (json_["accessors"][a.accessor].at("count").get<std::uint64_t>() != vertices_)
        fail("its attributes are not equally many");
    require(!attributes_.contains("COLOR_0") || json_.contains("materials"),
            "it has colours and no material");
    first_vertex_ = p.offset;
    vertex_bytes_ = p.stride;
    const Attribute i = place(primitive["indices"].get<std::size_t>());
    const json& indices = json_["accessors"][i.accessor];
    const int type = indices.at("componentType").get<int>();
    require((type == kUint || type == kUshort) && i.stride == i.bytes,
            "its indices are not of 16 or 32 bits side by side");
    const auto count = indices.at("count").get<std::uint64_t>();
    require(count >= 3 && count % 3 == 0, "its indices are no whole triangles");
    triangles_ = count / 3;
    first_face_ = i.offset;
    face_bytes_ = 3 * i.bytes;
  }

  /// Where a view lies in the file.
  [[nodiscard]] std::pair<std::size_t, std::size_t> view(std::size_t number) const {
    const json& v = json_.at("bufferViews").at(number);
    if (v.contains("extensions")) refuse("its buffers are packed");
    const auto offset = v.value("byteOffset", std::size_t{0});
    const auto length = v.at("byteLength").get<std::size_t>();
    if (v.at("buffer") != 0 || json_.at("buffers").at(0).contains("uri"))
      refuse("its data lie in another file");
    if (offset > bin_bytes_ || length > bin_bytes_ - offset)
      fail("buffer view " + std::to_string(number) + " reaches beyond the binary chunk");
    return {bin_ + offset, length};
  }

  [[nodiscard]] Attribute place(std::size_t number) const {
    const json& a = json_.at("accessors").at(number);
    if (a.contains("sparse") || !a.contains("bufferView")) refuse("an accessor is sparse");
    const auto of_view = a["bufferView"].get<std::size_t>();
    const auto [offset, length] = view(of_view);
    const int type = a.at("componentType").get<int>();
    const std::size_t each = type == kFloat || type == kUint   ? 4
                             : type == kUshort || type == 5122 ? 2
                                                               : 1;
    const std::size_t bytes = each * components(a.at("type").get<std::string>());
    if (bytes == 0) refuse("an accessor is of matrices");
    const auto inside = a.value("byteOffset", std::size_t{0});
    const auto stride = json_["bufferViews"][of_view].value("byteStride", bytes);
    const auto count = a.at("count").get<std::uint64_t>();
    if (stride < bytes || count == 0 || inside > length || length - inside < bytes ||
        count - 1 > (length - inside - bytes) / stride)
      fail("accessor " + std::to_string(number) + " reaches beyond its buffer view");
    return {number, offset + inside, stride, bytes};
  }

  static std::vector<std::byte> glb_of(std::string text, std::span<const std::byte> bin) {
    text.resize((text.size() + 3) / 4 * 4, ' ');
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
  std::size_t bin_ = 0, bin_bytes_ = 0;
  std::map<std::string, Attribute> attributes_;
};

}  // namespace

std::unique_ptr<LargeFile> open_large_glb(const std::filesystem::path& file) {
  return std::make_unique<LargeGlb>(file);
}

}  // namespace rastrum::io
