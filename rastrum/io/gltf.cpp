// SPDX-License-Identifier: BSD-3-Clause
// glTF 2.0 and GLB. The document is parsed (nlohmann::json) and checked whole (gltf_check.cpp).
// Then the scene's nodes are walked depth-first; meshes, buffers, materials and images are read
// when first used. All that moves becomes a Rig (gltf_rig.cpp), posed at rest. The reader is our
// own: tinygltf 2.7 trusts malformed documents (it reads beyond buffers and recurses without bound)
// and drops indices written as `1.0`; making it safe needs these same checks.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <rastrum/io/glb.hpp>
#include <rastrum/io/gltf_internal.hpp>

#include <rastrum/core/elementary.hpp>

namespace rastrum::io {
namespace {

using gltf::Json;

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
  look_from(c, to_world);
  return c;
}

std::uint64_t bytes_of(const Mesh& mesh) {
  return mesh.positions.size() * sizeof(Vec3) + mesh.indices.size() * sizeof(std::uint32_t) +
         mesh.normals.values.size() * sizeof(Vec3) + mesh.colors.values.size() * sizeof(Vec4) +
         mesh.texcoords.values.size() * sizeof(Vec2);
}

template <class T>
std::uint32_t size32(const std::vector<T>& v) {
  return static_cast<std::uint32_t>(v.size());
}

class GltfReader {
 public:
  GltfReader(const Json& document, Reading& reading, std::optional<Bytes> chunk, Scene& scene)
      : document_(document),
        scene_(scene),
        buffers_(document, reading, chunk),
        materials_(document, buffers_, scene) {}

  void read() {
    buffers_.budget().take(length(document_, "nodes"), sizeof(Rig::Node) + sizeof(Mat4d));
    gltf::read_nodes(document_, rig_);
    instancing_ = gltf::read_instancing(document_, buffers_, rig_);
    gltf::read_skins(document_, buffers_, rig_);
    Motion motion;
    motion.animations = gltf::read_animations(document_, buffers_, rig_, scene_.warnings);
    find_weights();
    to_world_ = to_root(rig_.nodes, rig_.parents_first);
    lights_ = gltf::read_lights(document_);
    for (const std::size_t root : roots()) walk(root);
    materials_.decode_images();
    check_unused_meshes();
    if (!motion.animations.empty() || !rig_.deformed.empty()) {
      std::ranges::sort(rig_.deformed, {}, &Rig::Deformed::mesh);
      motion.rig = std::make_unique<const Rig>(std::move(rig_));
      scene_.motions.push_back(std::move(motion));
      pose_at_rest(scene_);
    }
    if (scene_.instances.empty())
      scene_.warnings.push_back("its scene holds no triangles (" +
                                std::to_string(length(document_, "meshes")) + " meshes)");
    scene_.warnings.insert(scene_.warnings.end(), buffers_.warnings.begin(),
                           buffers_.warnings.end());
  }

 private:
  /// The nodes of the default scene; without scenes, the nodes without parents.
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

  /// Depth-first, without recursion. A root has no cycles, since every node has at most one parent
  /// (checked).
  void walk(std::size_t root) {
    std::vector<std::size_t> stack = {root};
    while (!stack.empty()) {
      const std::size_t index = stack.back();
      stack.pop_back();
      const Json node = document_["nodes"].at(index);
      if (const auto visibility = node.extension("KHR_node_visibility"))
        if (!visibility->boolean("visible", true)) continue;
      if (node.get("mesh")) place_all(index, node);
      if (const auto camera = node.get("camera")) {
        const Json c = document_["cameras"].at(camera->count());
        if (auto converted = read_camera(c, to_world_[index])) {
          rig_.cameras.push_back({size32(scene_.cameras), static_cast<std::uint32_t>(index)});
          scene_.cameras.push_back(*converted);
        } else {
          scene_.warnings.push_back(c.path() + " cannot be used and is left out");
        }
      }
      if (const auto light = gltf::light_of_node(node, lights_.size()))
        add_light(node, index, lights_[*light]);
      const auto children = node.get("children");
      if (!children) continue;
      for (std::size_t i = children->size(); i-- > 0;) stack.push_back(children->at(i).count());
    }
  }

  void add_light(const Json& node, std::size_t index, const std::optional<Light>& light) {
    const auto leave_out = [&](const char* why) {
      scene_.warnings.push_back(node.path() + ": its light " + why + " and is left out");
    };
    if (!light) return leave_out("has a kind that is not known");
    const Light standing = placed(*light, to_world_[index]);
    try {
      check_lights({&standing, 1});
    } catch (const Error&) {
      return leave_out("has no direction");
    }
    rig_.lamps.push_back({size32(scene_.lights), static_cast<std::uint32_t>(index), *light});
    scene_.lights.push_back(standing);
  }

  /// Broken meshes are refused, even if no node draws them.
  void check_unused_meshes() {
    std::vector<std::string> ignored;
    for (std::size_t i = 0, n = length(document_, "meshes"); i < n; ++i) {
      if (drawn_.count(i) != 0) continue;
      const Json owner = document_["meshes"].at(i);
      owner["primitives"].for_each(
          [&](const Json& p) { (void)read_part(p, owner, gltf::TextureUse{}, ignored); });
    }
  }

  /// A primitive, and what moves its vertices; null: nothing does.
  struct Part {
    std::variant<Mesh, Geometry> drawn;
    std::shared_ptr<const Rig::Shape> shape;
  };
  std::optional<Part> read_part(const Json& primitive, const Json& owner,
                                const gltf::TextureUse& use, std::vector<std::string>& warnings) {
    if (!gltf::has_positions(primitive, warnings)) return std::nullopt;
    const gltf::PrimitiveData data(primitive, document_, buffers_);
    if (gltf::is_points_or_lines(primitive)) {
      auto geometry = gltf::read_points_or_lines(primitive, data, warnings);
      if (!geometry) return std::nullopt;
      return Part{*std::move(geometry), nullptr};
    }
    auto mesh = gltf::read_primitive(primitive, data, use, warnings);
    if (!mesh) return std::nullopt;
    auto shape = gltf::read_shape(primitive, data, document_, owner, *mesh);
    return Part{*std::move(mesh), std::move(shape)};
  }

  struct Drawn {
    std::uint32_t mesh = 0;
    std::int32_t shape = Rig::kNone;
    std::optional<std::uint32_t> geometry{};
  };
  const std::vector<Drawn>& drawn(std::size_t index) {
    const auto [at, is_new] = drawn_.try_emplace(index);
    std::vector<Drawn>& all = at->second;
    if (!is_new) return all;
    const Json owner = document_["meshes"].at(index);
    owner["primitives"].for_each([&](const Json& p) {
      std::optional<std::size_t> material;
      if (const auto m = p.get("material")) material = m->count();
      auto part = read_part(p, owner, materials_.texture_use(material), scene_.warnings);
      if (!part) return;
      const auto name = [&](auto& g) {
        g.name = owner.string("name", "");
        g.material = materials_.use(material);
      };
      // glTF's default material is opaque.
      const auto opaque = [&](std::vector<Vec4>& colors) {
        for (Vec4& c : colors)
          if (!material) c.w = 1;
      };
      if (auto* const geometry = std::get_if<Geometry>(&part->drawn)) {
        std::visit(name, *geometry);
        std::visit([&](auto& g) { opaque(g.colors); }, *geometry);
        all.push_back({0, Rig::kNone, size32(scene_.geometries)});
        scene_.geometries.push_back(std::move(*geometry));
        return;
      }
      Mesh& mesh = std::get<Mesh>(part->drawn);
      name(mesh);
      opaque(mesh.colors.values);
      Drawn d{size32(scene_.meshes)};
      scene_.meshes.push_back(std::move(mesh));
      if (part->shape) {
        d.shape = static_cast<std::int32_t>(rig_.shapes.size());
        rig_.shapes.push_back(std::move(part->shape));
      }
      all.push_back(d);
    });
    return all;
  }

  /// Nodes that differ in these cannot share the mesh of a primitive.
  struct Cause {
    std::int32_t skin = Rig::kNone;
    std::int32_t weights = Rig::kNone;  ///< a node with its own
    friend auto operator<=>(const Cause&, const Cause&) = default;
  };

  void place_all(std::size_t index, const Json& node) {
    const auto many = instancing_.find(index);
    if (many == instancing_.end()) return place(index, node, index);
    const auto [first, count] = many->second;
    if (const auto skin = node.get("skin")) {
      scene_.warnings.push_back(skin->path() + ": its joints place it, not " + gltf::kInstancing +
                                ": it is drawn once");
      return place(index, node, index);
    }
    for (std::uint32_t i = 0; i < count; ++i) place(index, node, first + i);
  }

  /// Places instances at node `at` of the rig. They share the mesh of a primitive, unless deformed.
  void place(std::size_t index, const Json& node, std::size_t at) {
    for (const Drawn& d : drawn(node["mesh"].count())) {
      buffers_.budget().take(sizeof(Instance));
      if (d.geometry) {
        if (node.get("skin"))
          scene_.warnings.push_back(node["skin"].path() +
                                    ": points and lines are drawn without their skin");
        rig_.placed.push_back({size32(scene_.instances), static_cast<std::uint32_t>(at)});
        scene_.instances.push_back({0, to_world_[at], d.geometry});
        continue;
      }
      const Cause cause = cause_of(index, node, d);
      const auto [mesh, is_new] = posed_.try_emplace({d.mesh, cause}, d.mesh);
      if (is_new) {
        const auto other = posed_.lower_bound({d.mesh, Cause{}});
        const bool is_first = other == mesh && (std::next(mesh) == posed_.end() ||
                                                std::next(mesh)->first.first != d.mesh);
        if (!is_first) {
          mesh->second = size32(scene_.meshes);
          buffers_.budget().take(bytes_of(scene_.meshes[d.mesh]));
          scene_.meshes.push_back(Mesh(scene_.meshes[d.mesh]));
        }
        deform(mesh->second, d, cause, static_cast<std::uint32_t>(index));
      }
      // Joints place a skin, not its node.
      const bool is_skinned = cause.skin != Rig::kNone;
      if (!is_skinned)
        rig_.placed.push_back({size32(scene_.instances), static_cast<std::uint32_t>(at)});
      scene_.instances.push_back({mesh->second, is_skinned ? Mat4d::identity() : to_world_[at]});
    }
  }

  Cause cause_of(std::size_t index, const Json& node, const Drawn& d) {
    Cause cause;
    const auto skin = node.get("skin");
    const Rig::Shape* const shape =
        d.shape == Rig::kNone ? nullptr : rig_.shapes[static_cast<std::size_t>(d.shape)].get();
    if (skin && (shape == nullptr || shape->influences == 0))
      scene_.warnings.push_back(skin->path() + ": its mesh has no joints; it is drawn without");
    else if (skin)
      cause.skin = static_cast<std::int32_t>(skin->count());
    if (shape != nullptr && !shape->targets.empty() && has_weights_[index])
      cause.weights = static_cast<std::int32_t>(index);
    return cause;
  }

  void deform(std::uint32_t mesh, const Drawn& d, const Cause& cause, std::uint32_t node) {
    if (d.shape == Rig::kNone) return;
    const Rig::Shape& shape = *rig_.shapes[static_cast<std::size_t>(d.shape)];
    if (cause.skin != Rig::kNone) {
      const std::size_t joints = rig_.skins[static_cast<std::size_t>(cause.skin)].joints.size();
      for (const std::uint32_t j : shape.joints)
        if (j >= joints)
          document_["nodes"].at(node)["skin"].fail("has " + std::to_string(joints) +
                                                   " joints, but its mesh refers to joint " +
                                                   std::to_string(j));
    } else if (shape.targets.empty()) {
      return;
    }
    rig_.deformed.push_back({mesh, static_cast<std::uint32_t>(d.shape), cause.skin, node});
  }

  /// Finds nodes with weights of their own instead of their mesh's.
  void find_weights() {
    has_weights_.resize(rig_.nodes.size());
    for (std::size_t i = 0; i < rig_.nodes.size(); ++i)
      has_weights_[i] = !rig_.nodes[i].weights.empty();
    for (const Rig::Clip& clip : rig_.clips)
      for (const Rig::Track& track : clip.tracks)
        if (track.path == Rig::Path::weights) has_weights_[track.node] = true;
  }

  const Json& document_;
  std::vector<std::optional<Light>> lights_;  ///< of the document
  Scene& scene_;
  gltf::Buffers buffers_;
  gltf::Materials materials_;
  Rig rig_;
  std::map<std::size_t, std::pair<std::uint32_t, std::uint32_t>> instancing_;
  std::vector<bool> has_weights_;  ///< by node
  std::vector<Mat4d> to_world_;    ///< by node, at rest
  std::map<std::size_t, std::vector<Drawn>> drawn_;
  std::map<std::pair<std::uint32_t, Cause>, std::uint32_t> posed_;
};

}  // namespace

Scene parse_gltf(Bytes bytes, const std::filesystem::path& file, Reading& reading) {
  const std::string name = file.string();
  Scene scene;
  const Glb glb = is_glb(bytes) ? open_glb(bytes, name) : Glb{as_text(bytes), std::nullopt};
  if (glb.surplus != 0)
    scene.warnings.push_back(name + ": " + std::to_string(glb.surplus) +
                             " bytes behind its end are left out");
  nlohmann::json parsed;
  try {
    parsed = nlohmann::json::parse(glb.text.begin(), glb.text.end());
  } catch (const nlohmann::json::exception& e) {
    throw Error(Errc::bad_format, name + ": is not JSON: " + e.what());
  }
  const Json document(parsed, name);
  const std::size_t first = scene.warnings.size();
  gltf::check(document, scene.warnings);
  GltfReader(document, reading, glb.bin, scene).read();
  for (std::size_t i = first; i < scene.warnings.size(); ++i)
    scene.warnings[i].insert(0, name + ": ");
  return scene;
}

}  // namespace rastrum::io
