// SPDX-License-Identifier: BSD-3-Clause
// The checks that the rest of the glTF reader relies on (glTF 2.0, sections 3.5 to 3.11 and 5):
// every index exists, views lie in their buffers, accessors in their views, numbers in their
// specified ranges. Offsets stay below 2⁵⁵: counts are at most 2⁵³ (Json::count) and are divided,
// not multiplied.
#include <algorithm>
#include <set>
#include <string>
#include <string_view>

#include <rastrum/core/number_text.hpp>
#include <rastrum/io/gltf_internal.hpp>

namespace rastrum::io::gltf {
namespace {

void index(const Json& owner, const char* key, std::size_t limit, bool required = false) {
  if (required)
    (void)owner[key].index(limit);
  else if (const auto member = owner.get(key))
    (void)member->index(limit);
}

void range(const Json& owner, const char* key, double low, double high) {
  const auto member = owner.get(key);
  if (!member) return;
  const double x = member->number();
  if (x < low || x > high) member->fail(text_of("must lie between ", low, " and ", high));
}

void unique_indices(const Json& array, std::size_t limit) {
  std::set<std::size_t> seen;
  array.for_each([&](const Json& i) {
    if (!seen.insert(i.index(limit)).second) i.fail("appears twice");
  });
}

/// Whether `count` elements of `element` bytes, `stride` apart from `offset` on, fit into `size`.
bool fits(std::size_t count, std::size_t element, std::size_t stride, std::size_t offset,
          std::size_t size) {
  if (count == 0) return offset <= size;
  if (offset > size || element > size - offset) return false;
  return (count - 1) <= (size - offset - element) / std::max<std::size_t>(stride, 1);
}

struct Counts {
  std::size_t accessors, views, buffers, images, samplers, textures, materials, meshes, nodes,
      skins, cameras;
};

void check_buffers(const Json& document) {
  document.for_each("buffers", [](const Json& b) {
    if (b["byteLength"].count() == 0) b.fail("byteLength must be at least 1");
    if (const auto uri = b.get("uri")) (void)uri->string();
  });
}

/// A buffer view, or what an extension has in its place.
void check_in_buffer(const Json& v, const Json& document, const Counts& n) {
  const std::size_t buffer = v["buffer"].index(n.buffers);
  const std::size_t size = document["buffers"].at(buffer)["byteLength"].count();
  const std::size_t length = v["byteLength"].count();
  const std::size_t offset = v.count("byteOffset", 0);
  if (length == 0) v.fail("byteLength must be at least 1");
  if (offset > size || length > size - offset)
    v.fail("reaches beyond its buffer of " + std::to_string(size) + " bytes");
}

void check_views(const Json& document, const Counts& n) {
  document.for_each("bufferViews", [&](const Json& v) {
    check_in_buffer(v, document, n);
    if (const auto packed = v.extension(kMeshopt)) {
      check_in_buffer(*packed, document, n);
      check_meshopt(v, *packed);
    }
    if (const auto stride = v.get("byteStride")) {
      const std::size_t s = stride->count();
      if (s < 4 || s > 252 || s % 4 != 0) stride->fail("must be a multiple of 4 between 4 and 252");
    }
  });
}

void check_in_view(const Json& owner, const Json& document, const Counts& n, std::size_t count,
                   std::size_t used, std::size_t element) {
  const std::size_t view = owner["bufferView"].index(n.views);
  const Json v = document["bufferViews"].at(view);
  const std::size_t stride = v.count("byteStride", element);
  if (stride < used) owner.fail("its elements are longer than its view's byteStride");
  if (!fits(count, used, stride, owner.count("byteOffset", 0), v["byteLength"].count()))
    owner.fail("reaches beyond its buffer view of " + std::to_string(v["byteLength"].count()) +
               " bytes");
}

void check_accessors(const Json& document, const Counts& n) {
  document.for_each("accessors", [&](const Json& a) {
    const AccessorType type = accessor_type(a);
    const std::size_t count = a["count"].count();
    if (count == 0) a.fail("count must be at least 1");
    (void)a.boolean("normalized", false);
    for (const char* bound : {"min", "max"})
      a.for_each(bound, [](const Json& x) { (void)x.number(); });
    if (a.get("bufferView")) {
      check_in_view(a, document, n, count, type.used_bytes, type.element_bytes);
    } else if (a.get("byteOffset")) {
      a.fail("has a byteOffset without a bufferView");
    }
    const auto sparse = a.get("sparse");
    if (!sparse) return;
    const std::size_t some = (*sparse)["count"].count();
    if (some == 0 || some > count) sparse->fail("count must lie between 1 and the accessor's");
    const Json indices = (*sparse)["indices"];
    if (!is_unsigned(indices["componentType"].count()))
      indices.fail("componentType must be an unsigned integer's");
    const std::size_t bytes = component_bytes(indices["componentType"]);
    check_in_view(indices, document, n, some, bytes, bytes);
    check_in_view((*sparse)["values"], document, n, some, type.used_bytes, type.element_bytes);
  });
}

void check_texture_info(const Json& owner, const char* key, const Counts& n) {
  const auto info = owner.get(key);
  if (!info) return;
  index(*info, "index", n.textures, true);
  (void)info->count("texCoord", 0);
}

void check_materials(const Json& document, const Counts& n) {
  document.for_each("images", [&](const Json& i) {
    const bool in_view = i.get("bufferView").has_value();
    if (in_view == i.get("uri").has_value()) i.fail("must have either a uri or a bufferView");
    if (in_view) index(i, "bufferView", n.views);
    (void)i.string("uri", "");
  });
  document.for_each("samplers", [](const Json& s) {
    const auto one_of = [&](const char* key, std::initializer_list<std::size_t> values) {
      const auto member = s.get(key);
      if (member && std::find(values.begin(), values.end(), member->count()) == values.end())
        member->fail("has a value that the specification does not allow");
    };
    one_of("magFilter", {9728, 9729});
    one_of("minFilter", {9728, 9729, 9984, 9985, 9986, 9987});
    one_of("wrapS", {33071, 33648, 10497});
    one_of("wrapT", {33071, 33648, 10497});
  });
  document.for_each("textures", [&](const Json& t) {
    index(t, "source", n.images);
    index(t, "sampler", n.samplers);
    for (const char* key : {kWebp, kBasisu})
      if (const auto other = t.extension(key)) index(*other, "source", n.images);
  });
  document.for_each("materials", [&](const Json& m) {
    if (const auto pbr = m.get("pbrMetallicRoughness")) {
      double color[4];
      (void)pbr->numbers("baseColorFactor", color);
      range(*pbr, "metallicFactor", 0, 1);
      range(*pbr, "roughnessFactor", 0, 1);
      check_texture_info(*pbr, "baseColorTexture", n);
      check_texture_info(*pbr, "metallicRoughnessTexture", n);
    }
    if (const auto glossy = m.extension(kSpecularGlossiness)) {
      range(*glossy, "glossinessFactor", 0, 1);
      check_texture_info(*glossy, "diffuseTexture", n);
      check_texture_info(*glossy, "specularGlossinessTexture", n);
    }
    double emissive[3];
    (void)m.numbers("emissiveFactor", emissive);
    for (const char* key : {"normalTexture", "occlusionTexture", "emissiveTexture"})
      check_texture_info(m, key, n);
    const std::string mode = m.string("alphaMode", "OPAQUE");
    if (mode != "OPAQUE" && mode != "MASK" && mode != "BLEND")
      m.fail("alphaMode must be OPAQUE, MASK or BLEND");
    range(m, "alphaCutoff", 0, 1e30);
    (void)m.boolean("doubleSided", false);
  });
}

void check_meshes(const Json& document, const Counts& n) {
  document.for_each("meshes", [&](const Json& m) {
    if (m["primitives"].size() == 0) m.fail("has no primitives");
    m["primitives"].for_each([&](const Json& p) {
      const auto attributes = [&](const Json& set) {
        set.for_each_member([&](const std::string&, const Json& a) { (void)a.index(n.accessors); });
      };
      attributes(p["attributes"]);
      p.for_each("targets", attributes);
      index(p, "indices", n.accessors);
      index(p, "material", n.materials);
      if (const auto packed = p.extension(kDraco)) {
        index(*packed, "bufferView", n.views, true);
        (*packed)["attributes"].for_each_member(
            [](const std::string&, const Json& id) { (void)id.count(); });
      }
      if (p.count("mode", 4) > 6) p.fail("mode must lie between 0 and 6");
    });
    const std::size_t targets = length(m["primitives"].at(0), "targets");
    m["primitives"].for_each([&](const Json& p) {
      if (length(p, "targets") != targets)
        p.fail("has another number of morph targets than the first primitive");
    });
    const auto weights = m.get("weights");
    if (weights && weights->size() != targets)
      weights->fail("has " + std::to_string(weights->size()) + " numbers, but there are " +
                    std::to_string(targets) + " morph targets");
    if (weights) weights->for_each([](const Json& w) { (void)w.number(); });
  });
}

/// A node has at most one parent, so there is a loop if some cannot be reached from those without.
void check_loops(const Json& document, const std::vector<bool>& has_parent) {
  std::vector<std::size_t> stack;
  for (std::size_t i = 0; i < has_parent.size(); ++i)
    if (!has_parent[i]) stack.push_back(i);
  std::size_t reached = 0;
  for (; !stack.empty(); ++reached) {
    const Json node = document["nodes"].at(stack.back());
    stack.pop_back();
    node.for_each("children", [&](const Json& c) { stack.push_back(c.count()); });
  }
  if (reached != has_parent.size()) document["nodes"].fail("some nodes are their own ancestors");
}

void check_nodes(const Json& document, const Counts& n) {
  document.for_each("cameras", [](const Json& c) {
    const std::string type = c["type"].string();
    const bool perspective = type == "perspective";
    if (!perspective && type != "orthographic") return;  // unknown kinds are not drawn
    const Json lens = c[type.c_str()];
    for (const char* key : {perspective ? "yfov" : "xmag", perspective ? "znear" : "ymag"})
      (void)lens[key].real();
    (void)lens.real("zfar", 1);
    if (perspective) {
      if (lens["yfov"].number() <= 0) lens.fail("yfov must be positive");
      if (lens["znear"].number() <= 0) lens.fail("znear must be positive");
      if (lens.real("aspectRatio", 1) <= 0) lens.fail("aspectRatio must be positive");
    } else if (lens["znear"].number() < 0 || lens["xmag"].number() == 0 ||
               lens["ymag"].number() == 0) {
      lens.fail("znear must not be negative, xmag and ymag not zero");
    }
    const auto zfar = lens.get("zfar");
    if (zfar && zfar->number() <= lens["znear"].number()) zfar->fail("must be beyond znear");
  });
  document.for_each("skins", [&](const Json& s) {
    unique_indices(s["joints"], n.nodes);
    index(s, "inverseBindMatrices", n.accessors);
    index(s, "skeleton", n.nodes);
  });
  std::vector<bool> has_parent(n.nodes);
  document.for_each("nodes", [&](const Json& node) {
    index(node, "mesh", n.meshes);
    index(node, "skin", n.skins);
    index(node, "camera", n.cameras);
    if (const auto many = node.extension(kInstancing))
      (*many)["attributes"].for_each_member(
          [&](const std::string&, const Json& a) { (void)a.index(n.accessors); });
    if (const auto children = node.get("children")) {
      unique_indices(*children, n.nodes);
      children->for_each([&](const Json& c) {
        if (has_parent[c.count()]) c.fail("the node has another parent");
        has_parent[c.count()] = true;
      });
    }
    double m[16], t[3], r[4];
    const bool matrix = node.numbers("matrix", m);
    const bool trs = static_cast<int>(node.numbers("translation", t)) |
                     static_cast<int>(node.numbers("rotation", r)) |
                     static_cast<int>(node.numbers("scale", t));
    if (matrix && trs) node.fail("has both a matrix and translation, rotation or scale");
    if (matrix && (m[3] != 0 || m[7] != 0 || m[11] != 0 || m[15] != 1))
      node.fail("its matrix is not affine");
    if (node.get("rotation") && r[0] == 0 && r[1] == 0 && r[2] == 0 && r[3] == 0)
      node.fail("its rotation is zero");
  });
  check_loops(document, has_parent);
  document.for_each("scenes", [&](const Json& s) {
    const auto roots = s.get("nodes");
    if (!roots) return;
    unique_indices(*roots, n.nodes);
    roots->for_each([&](const Json& r) {
      if (has_parent[r.count()]) r.fail("the node is not a root");
    });
  });
  index(document, "scene", length(document, "scenes"));
}

void check_animations(const Json& document, const Counts& n) {
  document.for_each("animations", [&](const Json& a) {
    const std::size_t samplers = a["samplers"].size();
    a["samplers"].for_each([&](const Json& s) {
      index(s, "input", n.accessors, true);
      index(s, "output", n.accessors, true);
    });
    a["channels"].for_each([&](const Json& c) {
      index(c, "sampler", samplers, true);
      index(c["target"], "node", n.nodes);
    });
  });
}

void check_asset(const Json& document) {
  const Json asset = document["asset"];
  const auto major = [](const Json& v) {
    const std::string& s = v.string();
    const auto dot = s.find('.');
    const bool digits = dot != std::string::npos && dot != 0 && dot + 1 < s.size() &&
                        s.find_first_not_of("0123456789.") == std::string::npos &&
                        s.find('.', dot + 1) == std::string::npos;
    if (!digits) v.fail("must be two numbers and a point");
    return s.substr(0, dot);
  };
  for (const char* key : {"version", "minVersion"}) {
    const auto v = key[0] == 'v' ? std::optional(asset[key]) : asset.get(key);
    if (v && major(*v) != "2")
      v->fail("only glTF 2 is read, not " + v->string().substr(0, 20), Errc::unsupported);
  }
}

/// Extensions that are implemented, or have no effect on a still picture.
constexpr std::string_view kKnown[] = {
    kMeshopt,
    kInstancing,
    kWebp,
    "KHR_animation_pointer",
    kBasisu,
    kDraco,
    kSpecularGlossiness,
    "KHR_lights_punctual",
    "KHR_materials_emissive_strength",
    "KHR_materials_unlit",
    "KHR_materials_variants",
    "KHR_mesh_quantization",
    "KHR_node_visibility",
    "KHR_texture_transform",
};

void check_extensions(const Json& document, std::vector<std::string>& warnings) {
  const auto unknown = [&](const char* key) {
    std::string list;
    document.for_each(key, [&](const Json& e) {
      if (std::find(std::begin(kKnown), std::end(kKnown), e.string()) == std::end(kKnown))
        list += (list.empty() ? "" : ", ") + e.string().substr(0, 60);
    });
    return list;
  };
  if (const std::string required = unknown("extensionsRequired"); !required.empty())
    document.fail("requires extensions that are not supported: " + required, Errc::unsupported);
  if (const std::string used = unknown("extensionsUsed"); !used.empty())
    warnings.push_back("extensions that are not drawn: " + used);
}

}  // namespace

std::size_t component_bytes(const Json& component_type) {
  const std::size_t type = component_type.count();
  if (type < kByte || type > kFloat || (type > kUshort && type < kUint))
    component_type.fail("has a value that the specification does not allow");
  return with_component(type, [](auto v) { return sizeof(v); });
}

AccessorType accessor_type(const Json& accessor) {
  struct Shape {
    std::string_view name;
    std::size_t columns, rows;
  };
  static constexpr Shape kShapes[] = {{"SCALAR", 1, 1}, {"VEC2", 1, 2}, {"VEC3", 1, 3},
                                      {"VEC4", 1, 4},   {"MAT2", 2, 2}, {"MAT3", 3, 3},
                                      {"MAT4", 4, 4}};
  AccessorType t;
  t.component_type = accessor["componentType"].count();
  t.component_bytes = component_bytes(accessor["componentType"]);
  const std::string& type = accessor["type"].string();
  for (const Shape& s : kShapes) {
    if (s.name != type) continue;
    t.components = s.columns * s.rows;
    std::size_t column = s.rows * t.component_bytes;
    if (s.columns > 1) column = (column + 3) / 4 * 4;
    t.element_bytes = s.columns * column;
    t.used_bytes = (s.columns - 1) * column + s.rows * t.component_bytes;
  }
  return t;
}

void check(const Json& document, std::vector<std::string>& warnings) {
  if (!document.is_object()) document.fail("must be an object");
  check_asset(document);
  check_extensions(document, warnings);
  const Counts n = {
      length(document, "accessors"), length(document, "bufferViews"), length(document, "buffers"),
      length(document, "images"),    length(document, "samplers"),    length(document, "textures"),
      length(document, "materials"), length(document, "meshes"),      length(document, "nodes"),
      length(document, "skins"),     length(document, "cameras")};
  check_buffers(document);
  check_views(document, n);
  check_accessors(document, n);
  check_materials(document, n);
  check_meshes(document, n);
  check_nodes(document, n);
  check_animations(document, n);
}

}  // namespace rastrum::io::gltf
