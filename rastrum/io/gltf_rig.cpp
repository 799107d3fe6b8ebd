// SPDX-License-Identifier: BSD-3-Clause
// Nodes, skins, morph targets and animations of glTF as a Rig (scene/rig.hpp). gltf_check.cpp has
// checked indices; this file checks what accessors hold, used or not.
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <utility>

#include <rastrum/io/gltf_internal.hpp>

namespace rastrum::io::gltf {
namespace {

/// `q`: x, y, z, w, not all 0.
Quaternion unit(const double (&q)[4]) {
  const double l = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  return {q[3] / l, q[0] / l, q[1] / l, q[2] / l};
}

Rig::Node read_node(const Json& node) {
  Rig::Node r;
  double m[16];
  if (node.numbers("matrix", m)) {
    r.has_matrix = true;
    r.matrix = matrix_from_columns(m);
    return r;
  }
  double t[3] = {0, 0, 0}, q[4] = {}, s[3] = {1, 1, 1};
  (void)node.numbers("translation", t);
  (void)node.numbers("scale", s);
  if (node.numbers("rotation", q)) r.rotation = unit(q);
  r.translation = {t[0], t[1], t[2]};
  r.scale = {s[0], s[1], s[2]};
  return r;
}

/// The morph targets of a node's mesh; all its primitives have as many (checked).
std::size_t target_count(const Json& node, const Json& document) {
  const auto mesh = node.get("mesh");
  if (!mesh) return 0;
  return length(document["meshes"].at(mesh->count())["primitives"].at(0), "targets");
}

std::vector<double> numbers(const Json& owner, const char* key) {
  std::vector<double> r;
  owner.for_each(key, [&](const Json& x) { r.push_back(x.number()); });
  return r;
}

std::vector<float> finite_floats(const Json& accessor, Buffers& buffers) {
  std::vector<float> r = buffers.floats(accessor);
  if (!std::ranges::all_of(r, [](float x) { return std::isfinite(x); }))
    accessor.fail("holds a number that is not finite");
  return r;
}

/// A vertex attribute, spread over sets of four: JOINTS_0, JOINTS_1 …
struct Set {
  Json joints, weights;
};
std::vector<Set> joint_sets(const PrimitiveData& data, const Json& primitive) {
  std::vector<Set> r;
  for (std::size_t i = 0;; ++i) {
    const std::string number = std::to_string(i);
    const auto joints = data.attribute("JOINTS_" + number);
    const auto weights = data.attribute("WEIGHTS_" + number);
    if (joints.has_value() != weights.has_value())
      primitive.fail("has only one of JOINTS_" + number + " and WEIGHTS_" + number);
    if (!joints) return r;
    const std::size_t type = accessor_type(*joints).component_type;
    if ((type != kUbyte && type != kUshort) || joints->boolean("normalized", false))
      joints->fail("is read as joints, but is not of unsigned bytes or shorts");
    for (const Json& accessor : {*joints, *weights})
      if (accessor_type(accessor).components != 4)
        accessor.fail("has the wrong type for its attribute");
    r.push_back({*joints, *weights});
  }
}

void read_joints(const Json& primitive, const PrimitiveData& data, Rig::Shape& shape) {
  const std::vector<Set> sets = joint_sets(data, primitive);
  const std::size_t n = data.vertices();
  shape.influences = 4 * sets.size();
  shape.joints.resize(n * shape.influences);
  shape.weights.resize(n * shape.influences);
  for (std::size_t s = 0; s < sets.size(); ++s) {
    const std::vector<Vec4> joints = data.read<Vec4>("JOINTS_" + std::to_string(s));
    const std::vector<Vec4> weights = data.read<Vec4>("WEIGHTS_" + std::to_string(s));
    for (std::size_t v = 0; v < n; ++v) {
      const std::size_t at = v * shape.influences + 4 * s;
      const float j[4] = {joints[v].x, joints[v].y, joints[v].z, joints[v].w};
      const float w[4] = {weights[v].x, weights[v].y, weights[v].z, weights[v].w};
      for (std::size_t k = 0; k < 4; ++k) {
        if (!(w[k] >= 0 && std::isfinite(w[k])))
          sets[s].weights.fail("vertex " + std::to_string(v) +
                               " has a weight that is not a number from 0 on");
        shape.joints[at + k] = static_cast<std::uint32_t>(j[k]);
        shape.weights[at + k] = w[k];
      }
    }
  }
}

std::vector<Vec3> displacements(const Json& target, const char* key, const Json& document,
                                const PrimitiveData& data) {
  const auto index = target.get(key);
  if (!index) return {};
  return data.read<Vec3>(document["accessors"].at(index->count()));
}

/// The keys of samplers. A shared accessor is read once.
class Keys {
 public:
  Keys(const Json& document, Buffers& buffers) : document_(document), buffers_(buffers) {}

  std::size_t check_times(const Json& index) const {
    const Json accessor = accessor_of(index);
    const AccessorType type = accessor_type(accessor);
    if (type.component_type != kFloat || type.components != 1)
      accessor.fail("is read as times, but is not SCALAR of floats");
    return accessor["count"].count();
  }
  /// Checks for `each` elements of `components` per key.
  void check_values(const Json& index, std::size_t keys, std::size_t each,
                    std::size_t components) const {
    const Json accessor = accessor_of(index);
    const AccessorType type = accessor_type(accessor);
    const bool is_integer = type.component_type != kFloat;
    if (type.components != components || type.component_type == kUint ||
        (is_integer && (components == 3 || !accessor.boolean("normalized", false))))
      accessor.fail("has the wrong type for what it moves");
    const std::size_t count = accessor["count"].count();
    if (count % each != 0 || count / each != keys)
      accessor.fail("has " + std::to_string(count) + " elements, but there are " +
                    std::to_string(keys) + " keys of " + std::to_string(each));
  }
  /// Null if the document leaves the times to an application.
  Rig::Floats times(const Json& index) {
    const Json accessor = accessor_of(index);
    if (!buffers_.has_bytes(accessor)) return nullptr;
    const auto [kept, is_new] = read(index);
    const std::vector<float>& times = *kept;
    for (std::size_t i = 0; is_new && i < times.size(); ++i)
      if (times[i] < 0 || (i > 0 && !(times[i] > times[i - 1])))
        accessor.fail("is read as times, but time " + std::to_string(i) +
                      " does not rise from 0 on");
    return kept;
  }
  Rig::Floats values(const Json& index) { return read(index).first; }

 private:
  Json accessor_of(const Json& index) const { return document_["accessors"].at(index.count()); }
  std::pair<Rig::Floats, bool> read(const Json& index) {
    Rig::Floats& kept = floats_[index.count()];
    const bool is_new = kept == nullptr;
    if (is_new)
      kept = std::make_shared<std::vector<float>>(finite_floats(accessor_of(index), buffers_));
    return {kept, is_new};
  }

  const Json& document_;
  Buffers& buffers_;
  std::map<std::size_t, Rig::Floats> floats_;
};

Rig::Interpolation interpolation_of(const Json& sampler) {
  const std::string name = sampler.string("interpolation", "LINEAR");
  if (name == "LINEAR") return Rig::Interpolation::linear;
  if (name == "STEP") return Rig::Interpolation::step;
  if (name == "CUBICSPLINE") return Rig::Interpolation::cubic_spline;
  sampler["interpolation"].fail("must be LINEAR, STEP or CUBICSPLINE");
}

std::optional<Rig::Path> path_of(const Json& target) {
  const std::string& name = target["path"].string();
  if (name == "translation") return Rig::Path::translation;
  if (name == "rotation") return Rig::Path::rotation;
  if (name == "scale") return Rig::Path::scale;
  if (name == "weights") return Rig::Path::weights;
  return std::nullopt;
}

/// None, with a warning, unless the channel moves a property of a node.
std::optional<Rig::Track> read_track(const Json& channel, const Json& animation,
                                     const Json& document, Keys& keys,
                                     std::vector<std::string>& warnings) {
  const Json target = channel["target"];
  const auto node = target.get("node");
  const auto path = path_of(target);
  if (!node || !path) {
    warnings.push_back(target.path() + " is no property of a node; it does not move");
    return std::nullopt;
  }
  Rig::Track t;
  t.node = static_cast<std::uint32_t>(node->count());
  t.path = *path;
  const Json moved = document["nodes"].at(t.node);
  const bool of_weights = t.path == Rig::Path::weights;
  if (!of_weights && moved.get("matrix")) node->fail("has a matrix, which cannot be animated");
  t.width = of_weights ? target_count(moved, document) : t.path == Rig::Path::rotation ? 4 : 3;
  if (t.width == 0) node->fail("has no morph targets whose weights could move");

  const Json sampler = animation["samplers"].at(channel["sampler"].count());
  t.interpolation = interpolation_of(sampler);
  const bool cubic = t.interpolation == Rig::Interpolation::cubic_spline;
  const std::size_t count = keys.check_times(sampler["input"]);
  if (cubic && count < 2) sampler["input"].fail("a cubic spline has two keys at least");
  const std::size_t components = of_weights ? 1 : t.width;
  keys.check_values(sampler["output"], count, t.width / components * (cubic ? 3 : 1), components);
  t.times = keys.times(sampler["input"]);
  if (t.times == nullptr) {
    warnings.push_back(sampler.path() + " has no times; what it moves stands still");
    return std::nullopt;
  }
  t.values = keys.values(sampler["output"]);
  return t;
}

}  // namespace

void read_nodes(const Json& document, Rig& rig) {
  document.for_each("nodes", [&](const Json& node) {
    rig.nodes.push_back(read_node(node));
    rig.nodes.back().weights = numbers(node, "weights");
    const std::size_t weights = rig.nodes.back().weights.size();
    if (const std::size_t targets = target_count(node, document);
        weights != 0 && weights != targets)
      node["weights"].fail("has " + std::to_string(weights) + " numbers, but there are " +
                           std::to_string(targets) + " morph targets");
  });
  std::vector<std::uint32_t>& order = rig.parents_first;
  for (std::size_t i = 0; i < rig.nodes.size(); ++i)
    document["nodes"].at(i).for_each("children", [&](const Json& c) {
      rig.nodes[c.count()].parent = static_cast<std::int32_t>(i);
    });
  for (std::size_t i = 0; i < rig.nodes.size(); ++i)
    if (rig.nodes[i].parent == Rig::kNone) order.push_back(static_cast<std::uint32_t>(i));
  for (std::size_t i = 0; i < order.size(); ++i)
    document["nodes"].at(order[i]).for_each(
        "children", [&](const Json& c) { order.push_back(static_cast<std::uint32_t>(c.count())); });
}

std::map<std::size_t, std::pair<std::uint32_t, std::uint32_t>> read_instancing(const Json& document,
                                                                               Buffers& buffers,
                                                                               Rig& rig) {
  std::map<std::size_t, std::pair<std::uint32_t, std::uint32_t>> by_node;
  const std::size_t nodes = rig.nodes.size();
  for (std::size_t i = 0; i < nodes; ++i) {
    const auto many = document["nodes"].at(i).extension(kInstancing);
    if (!many) continue;
    const Json attributes = (*many)["attributes"];
    std::optional<std::size_t> count;
    attributes.for_each_member([&](const std::string&, const Json& a) {
      const std::size_t n = document["accessors"].at(a.count())["count"].count();
      if (count && *count != n) a.fail("has another number of elements than the others");
      count = n;
    });
    if (!count) attributes.fail("is empty");
    buffers.budget().take(*count, sizeof(Rig::Node) + sizeof(Mat4d));
    const auto values = [&](const char* key, std::size_t components) {
      const auto a = attributes.get(key);
      if (!a) return std::vector<float>{};
      const Json accessor = document["accessors"].at(a->count());
      if (accessor_type(accessor).components != components)
        accessor.fail("has the wrong type for its attribute");
      return finite_floats(accessor, buffers);
    };
    const std::vector<float> t = values("TRANSLATION", 3), r = values("ROTATION", 4),
                             s = values("SCALE", 3);
    const auto vec = [](const std::vector<float>& v, std::size_t k) {
      return Vec3d{double{v[3 * k]}, double{v[3 * k + 1]}, double{v[3 * k + 2]}};
    };
    by_node[i] = {static_cast<std::uint32_t>(rig.nodes.size()), static_cast<std::uint32_t>(*count)};
    for (std::size_t k = 0; k < *count; ++k) {
      Rig::Node node;
      node.parent = static_cast<std::int32_t>(i);
      if (!t.empty()) node.translation = vec(t, k);
      if (!s.empty()) node.scale = vec(s, k);
      if (!r.empty()) {
        const double q[4] = {r[4 * k], r[4 * k + 1], r[4 * k + 2], r[4 * k + 3]};
        if (std::ranges::all_of(q, [](double x) { return x == 0; }))
          attributes["ROTATION"].fail("holds a rotation that is zero");
        node.rotation = unit(q);
      }
      rig.parents_first.push_back(static_cast<std::uint32_t>(rig.nodes.size()));
      rig.nodes.push_back(std::move(node));
    }
  }
  return by_node;
}

void read_skins(const Json& document, Buffers& buffers, Rig& rig) {
  document.for_each("skins", [&](const Json& skin) {
    Rig::Skin r;
    skin["joints"].for_each(
        [&](const Json& j) { r.joints.push_back(static_cast<std::uint32_t>(j.count())); });
    buffers.budget().resize(r.inverse_bind, r.joints.size(), Mat4d::identity());
    if (const auto index = skin.get("inverseBindMatrices")) {
      const Json accessor = document["accessors"].at(index->count());
      const AccessorType type = accessor_type(accessor);
      if (type.component_type != kFloat || type.components != 16)
        accessor.fail("is read as inverse bind matrices, but is not MAT4 of floats");
      if (accessor["count"].count() < r.joints.size())
        accessor.fail("has " + std::to_string(accessor["count"].count()) +
                      " matrices, but the skin has " + std::to_string(r.joints.size()) + " joints");
      const std::vector<float> m = finite_floats(accessor, buffers);
      for (std::size_t j = 0; j < r.joints.size(); ++j)
        r.inverse_bind[j] = matrix_from_columns(&m[16 * j]);
    }
    rig.skins.push_back(std::move(r));
  });
}

std::shared_ptr<const Rig::Shape> read_shape(const Json& primitive, const PrimitiveData& data,
                                             const Json& document, const Json& owner,
                                             const Mesh& mesh) {
  auto shape = std::make_shared<Rig::Shape>();
  read_joints(primitive, data, *shape);
  primitive.for_each("targets", [&](const Json& t) {
    shape->targets.push_back(
        {displacements(t, "POSITION", document, data), displacements(t, "NORMAL", document, data)});
  });
  if (shape->influences == 0 && shape->targets.empty()) return nullptr;
  shape->rest_weights = numbers(owner, "weights");
  shape->positions = mesh.positions;
  shape->normals = mesh.normals.values;
  return shape;
}

std::vector<Animation> read_animations(const Json& document, Buffers& buffers, Rig& rig,
                                       std::vector<std::string>& warnings) {
  std::vector<Animation> animations;
  Keys keys(document, buffers);
  document.for_each("animations", [&](const Json& a) {
    Animation animation{a.string("name", ""), 0};
    Rig::Clip clip;
    std::set<std::pair<std::uint32_t, Rig::Path>> moved;
    a["channels"].for_each([&](const Json& channel) {
      auto track = read_track(channel, a, document, keys, warnings);
      if (!track) return;
      if (!moved.insert({track->node, track->path}).second)
        channel.fail("moves what another channel of its animation moves");
      animation.duration_s = std::max(animation.duration_s, double{track->times->back()});
      clip.tracks.push_back(*std::move(track));
    });
    animations.push_back(std::move(animation));
    rig.clips.push_back(std::move(clip));
  });
  return animations;
}

}  // namespace rastrum::io::gltf
