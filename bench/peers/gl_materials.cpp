// SPDX-License-Identifier: BSD-3-Clause
// The OpenGL peer of `material`; see the header. llvmpipe executes both sides of a branch, so each
// material has a program of exactly its features.
#include "gl_materials.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <map>
#include <unordered_map>
#include <vector>

#include <rastrum/core/memory.hpp>
#include <rastrum/error.hpp>
#include <rastrum/raster/rules/srgb.hpp>
#include <rastrum/raster/shade/material.hpp>
#include <rastrum/raster/shade/material_constants.hpp>
#include <rastrum/raster/shade/material_triangle.hpp>
#include <rastrum/raster/shade/normals.hpp>
#include <rastrum/raster/shade/texture.hpp>
#include <rastrum/render.hpp>

#include "gl_context.hpp"
#include "gl_target.hpp"

namespace rastrum::bench {
namespace {

/// The features of a program, a bit each.
enum Feature : unsigned {
  kBaseTexture = 1,
  kMetallicRoughness = 2,
  kOcclusion = 4,
  kEmissive = 8,
  kAlphaMap = 16,
  kMask = 32,
  kColors = 64,
};
constexpr std::array<const char*, 7> kFeatureNames = {
    "BASE_TEXTURE", "METALLIC_ROUGHNESS", "OCCLUSION", "EMISSIVE", "ALPHA_MAP", "MASK", "COLORS"};
/// The first of these features have a texture, whose unit is the feature's bit.
constexpr int kTextures = 5;

constexpr const char* kMore = R"(
layout(location = 2) in vec2 texcoord;
layout(location = 3) in vec4 vertex_color;
out vec2 uv;
out vec4 tint;
void more() {
  uv = texcoord;
  tint = vertex_color;
})";

// `seen` is the visible side of the triangle's plane, from the derivatives of `v`, which lies in a
// plane too.
constexpr const char* kMain = R"(
in vec3 n;
in vec3 v;
in vec2 uv;
in vec4 tint;
uniform vec4 factors[3];
layout(binding = 0) uniform sampler2D base_texture;
layout(binding = 1) uniform sampler2D metallic_roughness_texture;
layout(binding = 2) uniform sampler2D occlusion_texture;
layout(binding = 3) uniform sampler2D emissive_texture;
layout(binding = 4) uniform sampler2D alpha_texture;
layout(location = 0) out vec4 color;

float pow5(float a) {
  float a2 = a * a;
  return a2 * a2 * a;
}

struct Surface {
  vec3 n, v;
  float nv;
  vec3 diffuse, f0;
  float alpha, alpha2;
};

vec3 reflected(Surface s, vec3 l, float radiance) {
  vec3 sum = s.v + l;
  vec3 halfway = sum * inversesqrt(max(dot(sum, sum), 1e-12));
  float nl = max(dot(s.n, l), 0.0);
  float nh = max(dot(s.n, halfway), 0.0);
  float vh = max(dot(s.v, halfway), 0.0);
  float lobe = nh * nh * (s.alpha2 - 1.0) + 1.0;
  float pi_d = s.alpha2 / (lobe * lobe);
  float visibility = 0.5 / mix(2.0 * nl * s.nv, nl + s.nv, s.alpha);
  vec3 f = mix(s.f0, vec3(1.0), pow5(clamp(1.0 - vh, 0.0, 1.0)));
  return (s.diffuse * (1.0 - f) + f * (pi_d * visibility)) * (nl * radiance);
}

void main() {
  vec4 base = factors[0];
#ifdef COLORS
  base *= tint;
#endif
#ifdef BASE_TEXTURE
  base *= texture(base_texture, uv);
#endif
#ifdef MASK
  float own_alpha = base.a;
#ifdef ALPHA_MAP
  own_alpha *= texture(alpha_texture, uv).r;
#endif
  if (own_alpha < factors[2].w) discard;
#endif
  float metallic = factors[1].x, roughness = factors[1].y, occluded = 1.0;
  vec3 emission = factors[2].xyz;
#ifdef METALLIC_ROUGHNESS
  vec2 both = texture(metallic_roughness_texture, uv).gb;
  roughness *= both.x;
  metallic *= both.y;
#endif
#ifdef OCCLUSION
  occluded = 1.0 + factors[1].z * (texture(occlusion_texture, uv).r - 1.0);
#endif
#ifdef EMISSIVE
  emission *= texture(emissive_texture, uv).rgb;
#endif
  metallic = clamp(metallic, 0.0, 1.0);
  roughness = clamp(roughness, kMinRoughness, 1.0);

  vec3 seen = cross(dFdx(v), dFdy(v));
  if (dot(seen, v) < 0.0) seen = -seen;
  Surface s;
  s.v = normalize(v);
  s.n = normalize(n);
  if (dot(s.n, seen) < 0.0) s.n = -s.n;
  float facing = dot(s.n, s.v);
  s.nv = max(facing, 1e-4);
  s.diffuse = base.rgb * (1.0 - metallic);
  s.f0 = mix(vec3(kDielectricF0), base.rgb, metallic);
  s.alpha = roughness * roughness;
  s.alpha2 = s.alpha * s.alpha;
  vec3 direct = reflected(s, kKeyLight, kKeyRadiance) + reflected(s, kFillLight, kFillRadiance);

  vec3 rise = max(vec3(1.0 - roughness) - s.f0, 0.0);
  vec3 specular = s.f0 + rise * pow5(clamp(1.0 - s.nv, 0.0, 1.0));
  vec3 ambient = s.diffuse * (kSkyMean + kSkySlope * s.n.y) +
                 specular * (kSkyMean + kSkySlope * (2.0 * facing * s.n.y - s.v.y));
  color = vec4(direct + ambient * occluded + emission, 1.0);
})";

std::string glsl(const char* name, float value) {
  char text[80];
  std::snprintf(text, sizeof text, "const float %s = %.9e;\n", name, static_cast<double>(value));
  return text;
}
std::string glsl(const char* name, Vec3 value) {
  char text[120];
  std::snprintf(text, sizeof text, "const vec3 %s = vec3(%.9e, %.9e, %.9e);\n", name,
                static_cast<double>(value.x), static_cast<double>(value.y),
                static_cast<double>(value.z));
  return text;
}

std::string fragment_shader(unsigned features) {
  std::string text = "#version 450 core\n";
  for (std::size_t i = 0; i < kFeatureNames.size(); ++i)
    if ((features >> i & 1U) != 0) text += "#define " + std::string(kFeatureNames[i]) + "\n";
  using namespace raster;
  return text + glsl("kKeyLight", kKeyLight) + glsl("kKeyRadiance", kKeyRadiance) +
         glsl("kFillLight", kFillLight) + glsl("kFillRadiance", kFillRadiance) +
         glsl("kSkyMean", kSkyMean) + glsl("kSkySlope", kSkySlope) +
         glsl("kDielectricF0", kDielectricF0) + glsl("kMinRoughness", kMinRoughness) + kMain;
}

struct Vertex {
  Vec3 position, normal;
  Vec2 texcoord;
  Vec4 color;
};

/// The indices of a corner's values in its instance. Equal corners are one vertex.
struct Corner {
  std::uint32_t instance;
  std::size_t position, normal, texcoord, color;
  bool operator==(const Corner&) const = default;
};
struct CornerHash {
  std::size_t operator()(const Corner& c) const {
    std::size_t hash = c.instance;
    for (const std::size_t i : {c.position, c.normal, c.texcoord, c.color})
      hash = (hash ^ i) * 0x9e3779b97f4a7c15U;
    return hash ^ hash >> 32;
  }
};

/// Triangles of one material and one culling, in drawing order.
struct Group {
  bool has_mask;
  const raster::BoundMaterial* material;
  bool has_colors;
  Cull cull;
  auto operator<=>(const Group&) const = default;
};

/// The indices of one draw call.
struct Batch {
  GlProgram program;
  GLint factors = -1;
  std::array<Vec4, 3> values;
  std::array<GLuint, kTextures> textures{};
  Cull cull = Cull::none;
  GLsizei count = 0;
  std::size_t first = 0;  ///< of the indices
};

[[noreturn]] void refuse(const char* what) {
  throw Error(Errc::unsupported, std::string("GlMaterials: ") + what + " are not drawn");
}

void check_drawn(const SceneView& scene) {
  for (const Material& m : scene.materials) {
    if (m.alpha_mode == AlphaMode::blend || m.opacity != 1) refuse("materials that blend");
    if (m.normal_texture != kNoTexture) refuse("normal maps");
    if (m.unlit) refuse("unlit materials");
  }
  for (const InstanceView& i : scene.instances) {
    if (i.mesh() == nullptr) refuse("geometries other than meshes");
    if (i.opacity != 1 || i.color || !i.visible || !i.clip_planes.empty() ||
        i.winding != Winding::counter_clockwise || !scene.scalar_mappings.empty())
      refuse("instances with a look of their own");
    if (scene.materials.empty() && !i.mesh()->colors.empty()) refuse("colours that blend");
  }
}

}  // namespace

struct GlMaterials::Impl {
  GlContext context;
  const GlApi& gl = context.gl;
  GlTarget target{GL_SRGB8_ALPHA8};
  std::map<unsigned, GlProgram> programs;
  std::map<const raster::MipChain*, GLuint> textures;
  std::vector<Batch> batches;
  GLuint buffers[2] = {};  // vertices, indices

  explicit Impl(int threads) : context(threads) {
    gl.GenBuffers(2, buffers);
    gl.Enable(GL_FRAMEBUFFER_SRGB);
    gl.FrontFace(GL_CW);  // the vertex shader flips y
    context.check("start");
  }

  const GlProgram& program(unsigned features) {
    GlProgram& p = programs[features];
    if (p.name == 0) p = context.mesh_program(fragment_shader(features), kMore);
    return p;
  }

  void release_textures() {
    for (const auto& [chain, name] : textures) gl.DeleteTextures(1, &name);
    textures.clear();
  }

  GLuint texture(const raster::MipChain& chain) {
    GLuint& name = textures[&chain];
    if (name != 0) return name;
    gl.GenTextures(1, &name);
    gl.BindTexture(GL_TEXTURE_2D, name);
    const bool is_color = chain.use == raster::TexelUse::color;
    gl.TexStorage2D(GL_TEXTURE_2D, chain.levels, is_color ? GL_SRGB8_ALPHA8 : GL_RGBA8,
                    chain.level[0].width, chain.level[0].height);
    for (int i = 0; i < chain.levels; ++i)
      gl.TexSubImage2D(GL_TEXTURE_2D, i, 0, 0, chain.level[i].width, chain.level[i].height, GL_RGBA,
                       GL_UNSIGNED_BYTE, chain.level[i].texels);
    const auto wrap = [](Wrap w) {
      return w == Wrap::repeat            ? GL_REPEAT
             : w == Wrap::mirrored_repeat ? GL_MIRRORED_REPEAT
                                          : GL_CLAMP_TO_EDGE;
    };
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, wrap(chain.wrap_u));
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, wrap(chain.wrap_v));
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER,
                     chain.mag == TextureFilter::linear ? GL_LINEAR : GL_NEAREST);
    gl.TexParameteri(
        GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER,
        chain.min == TextureFilter::linear ? GL_LINEAR_MIPMAP_LINEAR : GL_NEAREST_MIPMAP_NEAREST);
    context.check("texture");
    return name;
  }

  Batch batch(const Group& group) {
    const raster::BoundMaterial& m = *group.material;
    const std::array<const raster::MipChain*, kTextures> chains{m.base_color, m.metallic_roughness,
                                                                m.occlusion, m.emissive,
                                                                group.has_mask ? m.alpha : nullptr};
    Batch b;
    unsigned features = (group.has_mask ? kMask : 0U) | (group.has_colors ? kColors : 0U);
    for (std::size_t i = 0; i < chains.size(); ++i) {
      if (chains[i] == nullptr) continue;
      features |= 1U << i;
      b.textures[i] = texture(*chains[i]);
    }
    b.program = program(features);
    b.factors = gl.GetUniformLocation(b.program.name, "factors");
    b.values = {m.base, Vec4{m.metallic, m.roughness, m.occlusion_strength, 0},
                Vec4{m.emission.x, m.emission.y, m.emission.z, m.alpha_cutoff}};
    b.cull = group.cull;
    return b;
  }

  void upload(const std::vector<Vertex>& vertices, const std::vector<std::uint32_t>& indices) {
    const auto bytes = [](std::size_t n) { return static_cast<GLsizeiptr>(n); };
    gl.BindBuffer(GL_ARRAY_BUFFER, buffers[0]);
    gl.BufferData(GL_ARRAY_BUFFER, bytes(vertices.size() * sizeof(Vertex)), vertices.data(),
                  GL_STATIC_DRAW);
    gl.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers[1]);
    gl.BufferData(GL_ELEMENT_ARRAY_BUFFER, bytes(indices.size() * sizeof(std::uint32_t)),
                  indices.data(), GL_STATIC_DRAW);
    const auto attribute = [&](GLuint place, GLint n, std::size_t offset) {
      gl.EnableVertexAttribArray(place);
      gl.VertexAttribPointer(place, n, GL_FLOAT, GL_FALSE, sizeof(Vertex),
                             reinterpret_cast<const void*>(offset));
    };
    attribute(0, 3, offsetof(Vertex, position));
    attribute(1, 3, offsetof(Vertex, normal));
    attribute(2, 2, offsetof(Vertex, texcoord));
    attribute(3, 4, offsetof(Vertex, color));
    context.check("upload");
  }
};

GlMaterials::GlMaterials(int threads) : impl_(std::make_unique<Impl>(threads)) {}
GlMaterials::~GlMaterials() = default;

std::string GlMaterials::description() const {
  return impl_->context.description();
}

void GlMaterials::set_scene(const SceneView& scene) {
  check_drawn(scene);
  Impl& s = *impl_;
  s.release_textures();
  s.batches.clear();
  MemoryAccount memory;
  raster::TextureSet chains(memory);
  chains.update(scene.textures, raster::texture_uses(scene, true, false), nullptr);
  const raster::MaterialScene bound(scene, Camera{}, 1, 1, chains);
  const raster::MaterialView materials = bound.view();

  std::vector<Vertex> vertices;
  std::unordered_map<Corner, std::uint32_t, CornerHash> known;
  std::map<Group, std::vector<std::uint32_t>> groups;
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
    const raster::MaterialDraw& draw = bound.draws[i];
    const MeshView& mesh = *draw.mesh;
    const Mat4 to_world = static_cast<Mat4>(scene.instances[i].object_to_world);
    const Cull cull = cull_on_screen(
        scene.instances[i], material_cull(scene.instances[i], scene.materials, Shader::material));
    for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
      const TrianglePlace place = mesh.place(t);
      const std::uint32_t vertex[3] = {mesh.vertex(place.corner[0]), mesh.vertex(place.corner[1]),
                                       mesh.vertex(place.corner[2])};
      const raster::BoundMaterial& m = materials.material_of(draw, t);
      auto& indices = groups[{m.alpha_mode == AlphaMode::mask, &m, !draw.colors.empty(), cull}];
      Vec3 normals[3];
      raster::corner_normals(mesh, place, vertex, normals);
      Vec4 colors[3];
      if (!draw.colors.empty()) raster::shown_colors(draw, materials, place, vertex, colors);
      for (std::size_t c = 0; c < 3; ++c) {
        const auto element = [&](const auto& a) {
          return a.values.empty() ? 0 : a.element(place, vertex, c);
        };
        const Corner corner{i, vertex[c], mesh.normals.empty() ? t : element(mesh.normals),
                            element(mesh.texcoords), element(draw.colors)};
        const auto [at, is_new] =
            known.try_emplace(corner, static_cast<std::uint32_t>(vertices.size()));
        indices.push_back(at->second);
        if (!is_new) continue;
        const Vec4 p = transform_point(to_world, mesh.positions[vertex[c]]);
        vertices.push_back({{p.x, p.y, p.z},
                            raster::times(draw.normal_matrix, normals[c]),
                            mesh.texcoords.empty() ? Vec2{} : mesh.texcoords.at(place, vertex, c),
                            colors[c]});
      }
    }
  }
  std::vector<std::uint32_t> indices;
  for (const auto& [group, own] : groups) {
    Batch& b = s.batches.emplace_back(s.batch(group));
    b.first = indices.size();
    b.count = static_cast<GLsizei>(own.size());
    indices.insert(indices.end(), own.begin(), own.end());
  }
  s.upload(vertices, indices);
}

void GlMaterials::set_view(const Camera& camera, int width, int height) {
  if (camera.orthographic) refuse("orthographic views");
  if (impl_->context.set_view(camera, width, height)) impl_->target.release(impl_->context);
}

void GlMaterials::draw() {
  Impl& s = *impl_;
  s.target.bind(s.context);
  s.context.clear_color();
  s.context.clear_depth();
  for (const Batch& b : s.batches) {
    s.context.use(b.program);
    s.gl.Uniform4fv(b.factors, static_cast<GLsizei>(b.values.size()), &b.values[0].x);
    for (std::size_t i = 0; i < b.textures.size(); ++i) {
      if (b.textures[i] == 0) continue;
      s.gl.ActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(i));
      s.gl.BindTexture(GL_TEXTURE_2D, b.textures[i]);
    }
    if (b.cull == Cull::none) {
      s.gl.Disable(GL_CULL_FACE);
    } else {
      s.gl.Enable(GL_CULL_FACE);
      s.gl.CullFace(b.cull == Cull::back ? GL_BACK : GL_FRONT);
    }
    s.gl.DrawElements(GL_TRIANGLES, b.count, GL_UNSIGNED_INT,
                      reinterpret_cast<const void*>(b.first * sizeof(std::uint32_t)));
  }
  s.gl.Finish();
}

Image<Rgba8> GlMaterials::colors() {
  return impl_->context.read<Rgba8>(GL_RGBA, GL_UNSIGNED_BYTE, "colors");
}

}  // namespace rastrum::bench
