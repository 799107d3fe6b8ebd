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

/// A decoded picture as its file has it: 8 bit, straight alpha, row 0 at the top. Whether it holds
/// sRGB (base colour, emissive) or linear data (the others) is the use's business.
struct Texture {
  std::string name{};
  Image<Rgba8> image{};
  Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
  TextureFilter mag = TextureFilter::linear, min = TextureFilter::linear;
  bool mipmaps = true;
};

inline constexpr std::int32_t kNoTexture = -1;

/// Factors are linear. A texture index refers to Scene::textures.
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
};

/// Keeps places p with normal · p + offset ≥ 0. The normal points to the side that is kept, and
/// need not be of unit length.
struct ClipPlane {
  Vec3d normal{};
  double offset = 0;
};
/// So many a frame, and so many an instance.
inline constexpr std::size_t kMaxClipPlanes = 8;

/// Any geometry over the caller's arrays.
using GeometryView =
    std::variant<MeshView, PointsView, LinesView, SpheresView, CylindersView, TubesView, DiscsView>;

/// A view that lies elsewhere. Its owner keeps it there, and a GeometryView of one kind, while this
/// is in use; any number of instances may refer to it. A temporary does not compile.
class GeometryRef {
  using Pointer =
      std::variant<const MeshView*, const PointsView*, const LinesView*, const SpheresView*,
                   const CylindersView*, const TubesView*, const DiscsView*>;
  template <class View>
  static constexpr bool is_kind = std::is_constructible_v<Pointer, const View*>;
  static constexpr MeshView kNothing{};

 public:
  GeometryRef() = default;  ///< of a mesh without triangles
  template <class View>
  requires is_kind<View> GeometryRef(const View& view) : view_(&view) {}
  GeometryRef(const GeometryView& view)
      : view_(std::visit([](const auto& v) -> Pointer { return &v; }, view)) {}
  template <class View>
  GeometryRef(const View&& temporary) = delete;

  /// Null where it is of another kind.
  template <class View>
  [[nodiscard]] const View* get_if() const {
    const auto* const view = std::get_if<const View*>(&view_);
    return view != nullptr ? *view : nullptr;
  }
  /// f(view), as std::visit of a GeometryView.
  template <class F>
  decltype(auto) visit(F&& f) const {
    return std::visit([&](const auto* view) -> decltype(auto) { return f(*view); }, view_);
  }
  /// Whether both refer to one view; equal ones that lie apart are not the same.
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
  /// In object space, at most kMaxClipPlanes: only the part of this instance that all of them keep
  /// is seen. FrameOptions::clip_planes says more.
  std::span<const ClipPlane> clip_planes{};
  /// One number for the whole instance: replaces the geometry's scalars.
  std::optional<double> scalar{};
  /// The mapping from its scalars to colours: an index into SceneView::scalar_mappings, where there
  /// are some. These replace colours, materials' base colours and textures.
  std::uint32_t scalar_mapping = 0;

  /// The triangle mesh that it draws; null: another geometry.
  [[nodiscard]] const MeshView* mesh() const { return geometry.get_if<MeshView>(); }
};

/// Spans over the caller's arrays. Without `materials` everything is drawn with plain_material().
struct SceneView {
  std::span<const InstanceView> instances{};
  std::span<const Material> materials{};
  std::span<const Texture> textures{};
  std::span<const ScalarMapping> scalar_mappings{};  ///< empty: scalars colour nothing
};

/// A geometry that is no mesh, with arrays of its own.
using Geometry = std::variant<Points, Lines, Spheres, Cylinders, Tubes, Discs>;
/// A view of its arrays, which must outlive it.
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
  std::vector<Light> lights{};    ///< of its files; a picture has those of FrameOptions
  std::vector<Motion> motions{};  ///< what moves: `pose` (motion.hpp)
  std::vector<ScalarMapping> scalar_mappings{};
  /// The name of the scalars that instances show, where their geometry has some of it; empty: none.
  std::string shown_scalars{};
  /// One sentence for each thing that a reader left out or found odd; nothing is lost silently.
  std::vector<std::string> warnings{};

  /// Appends `other` behind this scene: indices into meshes, geometries, materials and textures are
  /// shifted. Where one of the two has no materials it is given plain ones.
  void append(Scene other);
  /// Moves everything but the cameras: `to_world` lies before all matrices of instances, and moves
  /// lights.
  void place(const Mat4d& to_world);
  /// The triangles of the meshes of all instances. Throws Error{invalid_argument} for an instance
  /// whose mesh or geometry does not exist.
  [[nodiscard]] std::uint64_t triangle_count() const;
  /// The same and the primitives of other geometries: all that have an id. Throws likewise.
  [[nodiscard]] std::uint64_t primitive_count() const;
};

/// The material of instances that have none: the plain shaders' colour, or the geometry's own
/// colours, which blend.
[[nodiscard]] Material plain_material(bool has_colors);

/// Gives plain_material() to the meshes and geometries of a scene without materials. Their own
/// colours, and those of instances, blend.
void add_plain_materials(Scene& scene);

/// The borrowed form of a scene; keeps the instances that the span points to, and the views that
/// these refer to, which copies share. The scene must outlive it.
class SceneBinding {
 public:
  /// Throws Error{invalid_argument} for an instance whose mesh or geometry does not exist.
  explicit SceneBinding(const Scene& scene);
  explicit SceneBinding(const Scene&& temporary) = delete;
  /// Prepares its meshes (PreparedMesh), which are then to stay as they are: for many pictures.
  /// Throws as that.
  void prepare(int threads = 0);
  [[nodiscard]] SceneView view() const;

 private:
  void show(std::vector<GeometryView> views);

  Held<const Scene*> scene_;
  Shared<const std::vector<GeometryView>> views_;  ///< of meshes, then of geometries
  std::vector<InstanceView> instances_;
  std::vector<PreparedMesh> prepared_;
};

/// Axis-aligned box and the vertices it was taken from.
struct Bounds {
  Vec3d min{}, max{};
  std::uint64_t vertices_in_use = 0;  ///< 0: the box is meaningless
};

// Scalars.

/// Whether a picture shows numbers by colours of this instance: it has some, and a mapping.
[[nodiscard]] bool shows_scalars(const SceneView& scene, const InstanceView& instance);

/// The mapping with its range: its own, or from the least to the greatest finite number of the
/// instances that it is for (of those above 0 with a logarithm). Throws Error{invalid_argument} as
/// ScalarColors, and for a number that is none of a mapping. O(scalars).
[[nodiscard]] ScalarColors scalar_colors(const SceneView& scene, std::size_t mapping = 0);
/// The numbers that instances in view show by a mapping, from the least to the greatest that is
/// finite (and above 0, with a logarithm); where there is none it is upside down, from infinity to
/// −infinity. Throws as scalar_colors.
[[nodiscard]] ScalarRange scalars_in_use(const SceneView& scene, std::size_t mapping = 0);
/// The range that a mapping without one takes for these numbers; where there are none, all are one.
[[nodiscard]] ScalarRange range_of(const ScalarMapping& mapping, ScalarRange in_use);

/// The scalars of one name in a scene's geometries.
struct ScalarSummary {
  std::string name;
  std::uint64_t values = 0;
  ScalarRange range;      ///< of the finite ones
  std::uint64_t nan = 0;  ///< how many are not finite
  bool operator==(const ScalarSummary&) const = default;
};
/// In the order in which geometries have them. O(scalars).
[[nodiscard]] std::vector<ScalarSummary> scalar_summaries(const Scene& scene);

/// Sets Scene::shown_scalars. `x`, `y`, `z` and `distance` are made where no geometry has scalars
/// of the name: the place in the world, and how far it is from the middle of the scene's box; a
/// mesh or geometry of several instances then becomes one an instance. Throws Error{not_found},
/// which lists the names. `whole`: the box of the scene that this one is a part of.
void show_scalars(Scene& scene, const std::string& name, const Bounds* whole = nullptr);
/// Whether some geometry has scalars of that name.
[[nodiscard]] bool has_scalars(const Scene& scene, const std::string& name);

/// Bounds, in world space, of the finite vertices that primitives use. O(vertices + primitives).
/// Throws Error{invalid_argument} for an index out of range, as fit_camera.
[[nodiscard]] Bounds bounds(const SceneView& scene);

class FitRanks;  // fit.hpp

/// The default camera (`--fit`): centre = centre of the bounding box of the vertices in use,
/// r = distance of the farthest of them from it (0 counts as 1), eye = centre + (0, 0, d) with
/// d = r / sin(fov/2), looking along −z, +y up, planes as place_planes (fit.hpp) has them, all in
/// float64; orthographic: height 2 r. Throws Error{invalid_argument} unless
/// 0 < fov_rad < π, of an orthographic camera, too, and for directions that world_to_camera
/// refuses.
[[nodiscard]] Camera fit_camera(const SceneView& scene, float fov_rad, bool orthographic,
                                Vec3d direction = {0, 0, -1}, Vec3d up = {0, 1, 0},
                                FitRanks* ranks = nullptr);

/// Area-weighted vertex normals: at each position index the normalized sum of the cross products of
/// its triangles' edges. `positions.size()` values; (0, 0, 0) where no triangle touches. `indices`
/// as MeshView's: empty, they are the positions in order, and each triangle has its own normal.
/// Throws Error{invalid_argument} for an index out of range. O(positions + indices).
[[nodiscard]] std::vector<Vec3> vertex_normals(const ArrayView<Vec3>& positions,
                                               const IndexView& indices);

}  // namespace rastrum
