// SPDX-License-Identifier: BSD-3-Clause
// Scenes: instances of meshes and other geometries, with materials. `SceneView` borrows the
// caller's arrays, `Scene` owns what a reader made of a file.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include <rastrum/camera.hpp>
#include <rastrum/color_map.hpp>
#include <rastrum/held.hpp>
#include <rastrum/image.hpp>
#include <rastrum/light.hpp>
#include <rastrum/mat.hpp>
#include <rastrum/mesh.hpp>
#include <rastrum/motion.hpp>
#include <rastrum/points_and_lines.hpp>
#include <rastrum/prepared_mesh.hpp>
#include <rastrum/surfaces.hpp>
#include <rastrum/vec.hpp>

namespace RASTRUM_API rastrum {

enum class Wrap : std::uint8_t { repeat, mirrored_repeat, clamp_to_edge };
enum class TextureFilter : std::uint8_t { nearest, linear };  ///< linear minifies trilinearly
enum class AlphaMode : std::uint8_t { opaque, mask, blend };

/// A decoded picture as its file has it: 8 bit, straight alpha, row 0 at the top. Its use says
/// whether it holds sRGB (base colour, emissive) or linear data (the others).
struct Texture {
  std::string name{};
  Image<Rgba8> image{};
  Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
  TextureFilter mag = TextureFilter::linear, min = TextureFilter::linear;
  bool mipmaps = true;
};

inline constexpr std::int32_t kNoTexture = -1;

/// Shader::classic reads this of a material, beside the base colour and its texture. Light that is
/// mirrored is white times the light's specular colour; 128 · shininess is its exponent.
struct ClassicMaterial {
  float specular = 0.5F;   ///< how much is mirrored; ≥ 0
  float shininess = 0.5F;  ///< in [0, 1], in steps of 1/2048
  float emission = 0;      ///< how much of its base colour shines without light; ≥ 0
};

/// A surface's look. Factors are linear light. A texture is an index into Scene::textures.
struct Material {
  std::string name{};
  Vec4 base_color{1, 1, 1, 1};
  std::int32_t base_color_texture = kNoTexture;
  float metallic = 1, roughness = 1;
  std::int32_t metallic_roughness_texture = kNoTexture;  ///< G roughness, B metallic
  std::int32_t normal_texture = kNoTexture;
  float normal_scale = 1;
  std::int32_t occlusion_texture = kNoTexture;
  float occlusion_strength = 1;
  Vec3 emissive{0, 0, 0};
  std::int32_t emissive_texture = kNoTexture;
  /// An additional mask whose red channel multiplies alpha (OBJ's map_d).
  std::int32_t alpha_texture = kNoTexture;
  AlphaMode alpha_mode = AlphaMode::opaque;
  float alpha_cutoff = 0.5F;  ///< mask: a fragment with alpha < cutoff is discarded
  bool double_sided = false;
  bool unlit = false;  ///< KHR_materials_unlit
  /// The opacity of every surface that has this material, in [0, 1]. It is multiplied by
  /// FrameOptions::opacity.
  float opacity = 1;
  ClassicMaterial classic{};
};

/// Keeps places p with normal · p + offset ≥ 0. The normal points to the side that is kept, and
/// need not be of unit length.
struct ClipPlane {
  Vec3d normal{};
  double offset = 0;
};
/// The most clip planes of a frame, and of an instance.
inline constexpr std::size_t kMaxClipPlanes = 8;

/// Any geometry over the caller's arrays.
using GeometryView =
    std::variant<MeshView, PointsView, LinesView, SpheresView, CylindersView, TubesView, DiscsView>;

/// Refers to a view that lies elsewhere. Its owner keeps the view there, and a GeometryView of one
/// kind, while this is in use. Many instances may refer to one view. A temporary does not compile.
class GeometryRef {
  using Pointer =
      std::variant<const MeshView*, const PointsView*, const LinesView*, const SpheresView*,
                   const CylindersView*, const TubesView*, const DiscsView*>;
  template <class View>
  static constexpr bool is_kind = std::is_constructible_v<Pointer, const View*>;
  static constexpr MeshView kNothing{};

 public:
  GeometryRef() = default;  ///< refers to a mesh without triangles
  template <class View>
  requires is_kind<View> GeometryRef(const View& view) : view_(&view) {}
  GeometryRef(const GeometryView& view)
      : view_(std::visit([](const auto& v) -> Pointer { return &v; }, view)) {}
  template <class View>
  requires(is_kind<View> || std::is_same_v<View, GeometryView>) GeometryRef(const View&& temporary)
  = delete;

  /// The view; null if it is of another kind.
  template <class View>
  [[nodiscard]] const View* get_if() const {
    const auto* const view = std::get_if<const View*>(&view_);
    return view != nullptr ? *view : nullptr;
  }
  /// Calls f(view), as std::visit of a GeometryView does.
  template <class F>
  decltype(auto) visit(F&& f) const {
    return std::visit([&](const auto* view) -> decltype(auto) { return f(*view); }, view_);
  }
  /// Whether both refer to one view; equal views that lie apart are not the same.
  [[nodiscard]] bool operator==(const GeometryRef&) const = default;

 private:
  Pointer view_ = &kNothing;
};

/// The number of triangles, points, segments, spheres, cylinders or discs; each has an id. O(1).
[[nodiscard]] std::uint64_t primitive_count(GeometryRef geometry);

[[nodiscard]] inline bool is_points_or_lines(GeometryRef geometry) {
  return geometry.get_if<PointsView>() != nullptr || geometry.get_if<LinesView>() != nullptr;
}

/// A geometry placed in the world, with a look of its own. Ids count the primitives of the
/// instances in order.
struct InstanceView {
  GeometryRef geometry{};
  Mat4d object_to_world = Mat4d::identity();

  /// The opacity of the whole instance, in [0, 1]; it is multiplied by the frame's and the
  /// material's.
  float opacity = 1;
  /// Replaces the geometry's colours: display values, straight alpha.
  std::optional<Vec4> color{};
  /// Replaces the geometry's materials: an index into SceneView::materials.
  std::optional<std::uint32_t> material{};
  /// An invisible instance draws nothing, but its primitives keep their numbers.
  bool visible = true;
  Winding winding = Winding::counter_clockwise;
  /// The number of the instance in Targets::instances; none: its place in the scene.
  std::optional<std::int64_t> id{};
  /// Planes in object space, at most kMaxClipPlanes: only the part of this instance that all of
  /// them keep is seen. FrameOptions::clip_planes says more.
  std::span<const ClipPlane> clip_planes{};
  /// One number for the whole instance; it replaces the geometry's scalars.
  std::optional<double> scalar{};
  /// The mapping from its scalars to colours: an index into SceneView::scalar_mappings, if there
  /// are any. These colours replace the geometry's, and the materials' base colours and textures.
  std::uint32_t scalar_mapping = 0;
  bool casts_shadows = true;  ///< where FrameOptions::shadows asks for them

  /// The triangle mesh that it draws; null if it draws another geometry.
  [[nodiscard]] const MeshView* mesh() const { return geometry.get_if<MeshView>(); }
};

/// Spans over the caller's arrays. Without `materials` everything is drawn with plain_material().
struct SceneView {
  std::span<const InstanceView> instances{};
  std::span<const Material> materials{};
  std::span<const Texture> textures{};
  std::span<const ScalarMapping> scalar_mappings{};  ///< empty: scalars colour nothing
};

/// A geometry that is no mesh and owns its arrays.
using Geometry = std::variant<Points, Lines, Spheres, Cylinders, Tubes, Discs>;
/// A view of the arrays of `geometry`, which must outlive it.
[[nodiscard]] GeometryView view(const Geometry& geometry);

/// An instance of a Scene; InstanceView describes the fields of its look.
struct Instance {
  std::uint32_t mesh = 0;  ///< index into Scene::meshes
  Mat4d object_to_world = Mat4d::identity();
  /// Index into Scene::geometries, in place of a mesh.
  std::optional<std::uint32_t> geometry{};

  float opacity = 1;
  std::optional<Vec4> color{};
  std::optional<std::uint32_t> material{};  ///< index into Scene::materials
  bool visible = true;
  Winding winding = Winding::counter_clockwise;
  std::optional<std::int64_t> id{};
  std::vector<ClipPlane> clip_planes{};
  std::optional<double> scalar{};
  std::uint32_t scalar_mapping = 0;  ///< index into Scene::scalar_mappings
  bool casts_shadows = true;
};

/// The result of readers: meshes and other geometries, instances in order of submission, materials,
/// textures, cameras.
struct Scene {
  std::vector<Mesh> meshes{};
  std::vector<Geometry> geometries{};
  std::vector<Instance> instances{};
  std::vector<Material> materials{};  ///< empty: the file has none
  std::vector<Texture> textures{};
  std::vector<Camera> cameras{};
  std::vector<Light> lights{};    ///< from its files; a picture has those of FrameOptions
  std::vector<Motion> motions{};  ///< what `pose` moves (motion.hpp)
  std::vector<ScalarMapping> scalar_mappings{};
  /// The name of the scalars that instances show, if their geometry has scalars of that name;
  /// empty: none.
  std::string shown_scalars{};
  /// One sentence for each thing that a reader left out or found odd; nothing is lost silently.
  std::vector<std::string> warnings{};

  /// Appends `other` behind this scene; its indices into meshes, geometries, materials, textures
  /// and scalar mappings are shifted. If only one of the two has materials, the other is given
  /// plain ones.
  void append(Scene other);
  /// Moves everything but the cameras: puts `to_world` before the matrices of instances, and moves
  /// lights.
  void place(const Mat4d& to_world);
  /// The number of triangles in the meshes of all instances. Throws Error{invalid_argument} for an
  /// instance whose mesh or geometry does not exist.
  [[nodiscard]] std::uint64_t triangle_count() const;
  /// The number of these triangles and other primitives: all that have an id. Throws likewise.
  [[nodiscard]] std::uint64_t primitive_count() const;
};

/// The material of instances that have none. It shows the plain shaders' colour or, if
/// `has_colors`, the geometry's own colours, which blend.
[[nodiscard]] Material plain_material(bool has_colors);

/// Gives plain_material() to the meshes and geometries of a scene without materials. Their own
/// colours, and those of instances, blend.
void add_plain_materials(Scene& scene);

/// The borrowed form of a scene, which must outlive it. It keeps the instances that the span points
/// to, and the views that these refer to; copies share the views.
class SceneBinding {
 public:
  /// Throws Error{invalid_argument} for an instance whose mesh or geometry does not exist.
  explicit SceneBinding(const Scene& scene);
  explicit SceneBinding(const Scene&& temporary) = delete;
  /// Prepares the meshes (PreparedMesh) for many pictures; they must stay as they are from then on.
  /// `threads` 0: all. Throws as PreparedMesh.
  void prepare(int threads = 0);
  [[nodiscard]] SceneView view() const;

 private:
  void show(std::vector<GeometryView> views);

  Held<const Scene*> scene_;
  Shared<const std::vector<GeometryView>> views_;  ///< of meshes, then of geometries
  std::vector<InstanceView> instances_;
  std::vector<PreparedMesh> prepared_;
};

/// An axis-aligned box, and how many vertices it was taken from.
struct Bounds {
  Vec3d min{}, max{};
  std::uint64_t vertices_in_use = 0;  ///< 0: the box is meaningless
};

// Scalars.

/// Whether a picture shows numbers of this instance by colours: it has some, and a mapping.
[[nodiscard]] bool shows_scalars(const SceneView& scene, const InstanceView& instance);

/// The colours of a mapping over its range. A mapping without one takes that of scalars_in_use
/// (range_of). Throws Error{invalid_argument} as ScalarColors, and for a `mapping` out of range.
/// O(scalars).
[[nodiscard]] ScalarColors scalar_colors(const SceneView& scene, std::size_t mapping = 0);
/// The range of the numbers that visible instances show by a mapping, from the least to the
/// greatest that is finite (and above 0, if it is logarithmic). If there is none it is upside down,
/// from infinity to −infinity. Throws as scalar_colors.
[[nodiscard]] ScalarRange scalars_in_use(const SceneView& scene, std::size_t mapping = 0);
/// The range that a mapping without one takes for numbers of this range; if it is upside down, 0 to
/// 1, or 1 to 1 if the mapping is logarithmic.
[[nodiscard]] ScalarRange range_of(const ScalarMapping& mapping, ScalarRange in_use);

/// The scalars of one name in a scene's geometries.
struct ScalarSummary {
  std::string name;
  std::uint64_t values = 0;
  ScalarRange range;      ///< of the finite values
  std::uint64_t nan = 0;  ///< how many values are not finite
  bool operator==(const ScalarSummary&) const = default;
};
/// Summaries in the order in which geometries have the names. O(scalars).
[[nodiscard]] std::vector<ScalarSummary> scalar_summaries(const Scene& scene);

/// Sets Scene::shown_scalars. If no geometry has scalars of the name, `x`, `y`, `z` (the place in
/// the world) and `distance` (how far it is from the middle of the scene's box) are made; a mesh or
/// geometry of several instances then becomes one for each. Throws Error{not_found}, which lists
/// the names. `whole`: the box of the scene of which this one is a part.
void show_scalars(Scene& scene, const std::string& name, const Bounds* whole = nullptr);
/// Whether some geometry has scalars of that name.
[[nodiscard]] bool has_scalars(const Scene& scene, const std::string& name);

/// The box, in world space, of the finite vertices that primitives use. O(vertices + primitives).
/// Throws Error{invalid_argument} for an index out of range, as fit_camera.
[[nodiscard]] Bounds bounds(const SceneView& scene);

class FitRanks;  // fit.hpp

/// The default camera (`--fit`), computed in float64. It looks along `direction` at the centre of
/// bounds(scene). r is the distance from there to the farthest vertex in use (0 counts as 1), and
/// the eye is r / sin(fov/2) away. place_planes (fit.hpp) gives the planes; an orthographic picture
/// is 2 r high. Throws Error{invalid_argument} unless 0 < fov_rad < π, of an orthographic camera,
/// too, and for directions that world_to_camera refuses.
[[nodiscard]] Camera fit_camera(const SceneView& scene, float fov_rad, bool orthographic,
                                Vec3d direction = {0, 0, -1}, Vec3d up = {0, 1, 0},
                                FitRanks* ranks = nullptr);

/// Area-weighted vertex normals: for each position the normalized sum of the cross products of its
/// triangles' edges, (0, 0, 0) where no triangle touches. `indices` are as MeshView's: if they are
/// empty, positions are taken in order, and each triangle has its own normal. Throws
/// Error{invalid_argument} for an index out of range. O(positions + indices).
[[nodiscard]] std::vector<Vec3> vertex_normals(const ArrayView<Vec3>& positions,
                                               const IndexView& indices);

}  // namespace rastrum
