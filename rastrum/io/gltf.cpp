// glTF 2.0 and GLB. The document is parsed (nlohmann::json), checked whole (gltf_check.cpp), then
// the scene's nodes are walked depth-first; meshes, buffers, materials and images are read when
// they are first used. Own reader: tinygltf 2.7 takes malformed documents for granted (it reads
// beyond buffers and recurses without bound), drops numbers such as `1.0` where an index stands,
// and making it safe needs these same checks over the same JSON.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <rastrum/io/gltf_internal.hpp>

#include <rastrum/core/elementary.hpp>

namespace rastrum::io {
namespace {

using gltf::Json;

struct Container {
  std::string_view text;
  std::optional<Bytes> chunk;  ///< GLB's binary
};

std::uint32_t u32(Bytes bytes, std::size_t at) {
  std::uint32_t v = 0;
  for (std::size_t i = 4; i-- > 0;) v = v << 8 | static_cast<std::uint32_t>(bytes[at + i]);
  return v;
}

Container open_container(Bytes bytes, const std::string& name, std::vector<std::string>& warnings) {
  if (as_text(bytes).substr(0, 4) != "glTF") return {as_text(bytes), std::nullopt};
  const auto fail = [&](const std::string& what) {
    throw Error(Errc::bad_format, name + ": is not a sound GLB: " + what);
  };
  if (bytes.size() < 12) fail("its header is cut off");
  if (const std::uint32_t version = u32(bytes, 4); version != 2)
    throw Error(Errc::unsupported, name + ": is GLB of version " + std::to_string(version) +
                                       "; only version 2 is read");
  const std::size_t length = u32(bytes, 8);
  if (length > bytes.size())
    fail("its header says " + std::to_string(length) + " bytes, but there are " +
         std::to_string(bytes.size()));
  if (length < bytes.size())
    warnings.push_back(name + ": " + std::to_string(bytes.size() - length) +
                       " bytes behind its end are left out");
  Container r;
  std::size_t chunks = 0;
  for (std::size_t at = 12; at < length; ++chunks) {
    if (length - at < 8) fail("a chunk's header is cut off");
    const std::size_t size = u32(bytes, at);
    const std::uint32_t type = u32(bytes, at + 4);
    at += 8;
    if (size > length - at) fail("chunk " + std::to_string(chunks) + " is cut off");
    if (size % 4 != 0) fail("the length of chunk " + std::to_string(chunks) + " is not aligned");
    constexpr std::uint32_t kJson = 0x4E4F534A, kBin = 0x004E4942;
    if ((chunks == 0) != (type == kJson)) fail("its first chunk, and no other, must be JSON");
    if (type == kBin && (chunks != 1)) fail("a binary chunk may only be the second");
    if (type == kJson) r.text = as_text(bytes.subspan(at, size));
    if (type == kBin) r.chunk = bytes.subspan(at, size);
    at += size;
  }
  if (chunks == 0) fail("it has no chunks");
  return r;
}

Mat4d local_transform(const Json& node) {
  Mat4d r = Mat4d::identity();
  double m[16];
  if (node.numbers("matrix", m)) {
    for (int column = 0; column < 4; ++column)
      for (int row = 0; row < 4; ++row) r.m[row][column] = m[4 * column + row];
    return r;
  }
  double t[3] = {0, 0, 0}, q[4] = {0, 0, 0, 1}, s[3] = {1, 1, 1};
  (void)node.numbers("translation", t);
  (void)node.numbers("scale", s);
  if (node.numbers("rotation", q)) {
    const double l = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    for (double& x : q) x /= l;
  }
  const double x = q[0], y = q[1], z = q[2], w = q[3];
  const double rotation[3][3] = {
      {1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)},
      {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)},
      {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)}};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) r.m[i][j] = rotation[i][j] * s[j];
    r.m[i][3] = t[i];
  }
  return r;
}

/// glTF fixes the angle across the height, or the aspect; ours is across the smaller side.
std::optional<Camera> read_camera(const Json& camera, const Mat4d& to_world) {
  const std::string& type = camera["type"].string();
  Camera c;
  if (type == "perspective") {
    const Json lens = camera["perspective"];
    const double yfov = lens["yfov"].number();
    const double aspect = static_cast<double>(lens.real("aspectRatio", 1));
    if (yfov >= std::numbers::pi) return std::nullopt;
    c.fov_rad = static_cast<float>(
        aspect < 1 ? 2 * elementary::atan(elementary::tan(yfov / 2) * aspect) : yfov);
    c.near_plane = lens["znear"].real();
    if (const auto zfar = lens.get("zfar")) c.far_plane = zfar->real();
  } else if (type == "orthographic") {
    const Json lens = camera["orthographic"];
    c.orthographic = true;
    c.orthographic_height =
        2 * std::min(std::abs(lens["xmag"].real()), std::abs(lens["ymag"].real()));
    c.near_plane = lens["znear"].real();
    c.far_plane = lens["zfar"].real();
  } else {
    return std::nullopt;
  }
  const auto column = [&](int k, double sign) {
    return Vec3{static_cast<float>(sign * to_world.m[0][k]),
                static_cast<float>(sign * to_world.m[1][k]),
                static_cast<float>(sign * to_world.m[2][k])};
  };
  c.eye = column(3, 1);
  const Vec3 forward = normalize(column(2, -1));
  c.target = Vec3(c.eye) + forward;
  c.up = normalize(column(1, 1));
  return c;
}

class GltfReader {
 public:
  GltfReader(const Json& document, const std::filesystem::path& file, std::optional<Bytes> chunk,
             Scene& scene)
      : document_(document),
        scene_(scene),
        buffers_(document, file, chunk),
        materials_(document, buffers_, scene) {}

  void read() {
    for (const std::size_t root : roots()) walk(root);
    check_unused_meshes();
    if (scene_.instances.empty())
      scene_.warnings.push_back("its scene holds no triangles (" +
                                std::to_string(length(document_, "meshes")) + " meshes)");
    scene_.warnings.insert(scene_.warnings.end(), buffers_.warnings.begin(),
                           buffers_.warnings.end());
  }

 private:
  /// The nodes of the default scene; without scenes, those that are no child.
  std::vector<std::size_t> roots() {
    std::vector<std::size_t> r;
    if (const std::size_t scenes = length(document_, "scenes"); scenes != 0) {
      const std::size_t chosen = document_.count("scene", 0);
      document_["scenes"].at(chosen).for_each("nodes",
                                              [&](const Json& n) { r.push_back(n.count()); });
      if (scenes > 1)
        scene_.warnings.push_back("of its " + std::to_string(scenes) + " scenes scene " +
                                  std::to_string(chosen) + " is drawn");
      return r;
    }
    const std::size_t n = length(document_, "nodes");
    std::vector<bool> child(n);
    document_.for_each("nodes", [&](const Json& node) {
      node.for_each("children", [&](const Json& c) { child[c.count()] = true; });
    });
    for (std::size_t i = 0; i < n; ++i)
      if (!child[i]) r.push_back(i);
    return r;
  }

  /// Depth-first with a stack of its own. Every node has at most one parent (checked), so that
  /// from a root there are no cycles.
  void walk(std::size_t root) {
    struct Visit {
      std::size_t node;
      Mat4d parent;
    };
    std::vector<Visit> stack = {{root, Mat4d::identity()}};
    while (!stack.empty()) {
      const Visit v = stack.back();
      stack.pop_back();
      const Json node = document_["nodes"].at(v.node);
      if (const auto visibility = node.extension("KHR_node_visibility"))
        if (!visibility->boolean("visible", true)) continue;
      const Mat4d to_world = v.parent * local_transform(node);
      if (const auto mesh = node.get("mesh")) place(mesh->count(), node, to_world);
      if (const auto camera = node.get("camera")) {
        const Json c = document_["cameras"].at(camera->count());
        if (auto converted = read_camera(c, to_world))
          scene_.cameras.push_back(*converted);
        else
          scene_.warnings.push_back(c.path() + " cannot be used and is left out");
      }
      const auto children = node.get("children");
      if (!children) continue;
      for (std::size_t i = children->size(); i-- > 0;)
        stack.push_back({children->at(i).count(), to_world});
    }
  }

  /// A mesh that no node draws is read all the same: what is broken is refused, not drawn empty.
  void check_unused_meshes() {
    std::vector<std::string> ignored;
    for (std::size_t i = 0, n = length(document_, "meshes"); i < n; ++i) {
      if (meshes_.count(i) != 0) continue;
      document_["meshes"].at(i)["primitives"].for_each([&](const Json& p) {
        (void)read_primitive(p, document_, buffers_, gltf::TextureUse{}, ignored);
      });
    }
  }

  /// Every primitive is a mesh of ours; instances share them.
  void place(std::size_t index, const Json& node, const Mat4d& to_world) {
    const bool is_new = meshes_.count(index) == 0;
    std::vector<std::uint32_t>& ours = meshes_[index];
    if (is_new) {
      const Json mesh = document_["meshes"].at(index);
      mesh["primitives"].for_each([&](const Json& p) {
        std::optional<std::size_t> material;
        if (const auto m = p.get("material")) material = m->count();
        auto read = read_primitive(p, document_, buffers_, materials_.texture_use(material),
                                   scene_.warnings);
        if (!read) return;
        read->name = mesh.string("name", "");
        read->material = materials_.use(material);
        ours.push_back(static_cast<std::uint32_t>(scene_.meshes.size()));
        scene_.meshes.push_back(*std::move(read));
      });
    }
    if (node.get("skin"))
      scene_.warnings.push_back(node.path() + " has a skin; its mesh is drawn unposed");
    for (const std::uint32_t m : ours) scene_.instances.push_back({m, to_world});
  }

  const Json& document_;
  Scene& scene_;
  gltf::Buffers buffers_;
  gltf::Materials materials_;
  std::map<std::size_t, std::vector<std::uint32_t>> meshes_;
};

}  // namespace

Scene parse_gltf(Bytes bytes, const std::filesystem::path& file) {
  const std::string name = file.string();
  Scene scene;
  const Container container = open_container(bytes, name, scene.warnings);
  nlohmann::json parsed;
  try {
    parsed = nlohmann::json::parse(container.text.begin(), container.text.end());
  } catch (const nlohmann::json::exception& e) {
    throw Error(Errc::bad_format, name + ": is not JSON: " + e.what());
  }
  const Json document(parsed, name);
  const std::size_t first = scene.warnings.size();
  gltf::check(document, scene.warnings);
  GltfReader(document, file, container.chunk, scene).read();
  for (std::size_t i = first; i < scene.warnings.size(); ++i)
    scene.warnings[i].insert(0, name + ": ");
  return scene;
}

}  // namespace rastrum::io
