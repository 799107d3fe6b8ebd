// SPDX-License-Identifier: BSD-3-Clause
// The rig of a moving scene, as in glTF 2.0 (3.5.3 nodes, 3.7.2.2 morph targets, 3.7.3 skins, 3.11
// animations): plain data that readers fill and pose.cpp reads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include <rastrum/camera.hpp>
#include <rastrum/light.hpp>
#include <rastrum/mat.hpp>
#include <rastrum/motion.hpp>
#include <rastrum/transform.hpp>
#include <rastrum/vec.hpp>

namespace rastrum {

/// Indices are of the vectors here; `mesh`, `instance`, `camera` and `light` count from the file's
/// first.
struct Rig {
  static constexpr std::int32_t kNone = -1;

  struct Node {
    std::int32_t parent = kNone;
    bool has_matrix = false;  ///< then it is not animated
    Mat4d matrix = Mat4d::identity();
    Vec3d translation{};
    Quaternion rotation{};  ///< of unit length
    Vec3d scale{1, 1, 1};
    std::vector<double> weights{};  ///< of its mesh's morph targets; empty: the shape's own

    /// The transform to its parent: scaled, turned, moved.
    [[nodiscard]] Mat4d local() const;
  };
  std::vector<Node> nodes;
  std::vector<std::uint32_t> parents_first;  ///< all nodes in such an order

  struct Skin {
    std::vector<std::uint32_t> joints;  ///< nodes
    std::vector<Mat4d> inverse_bind;    ///< one per joint
  };
  std::vector<Skin> skins;

  /// A mesh as the file has it, before morphing and skinning.
  struct Shape {
    std::vector<Vec3> positions, normals;  ///< normals may be empty
    struct Target {
      std::vector<Vec3> positions, normals;  ///< displacements; either may be empty
    };
    std::vector<Target> targets;
    std::vector<double> rest_weights;   ///< of the targets; missing ones are 0
    std::size_t influences = 0;         ///< joints per vertex
    std::vector<std::uint32_t> joints;  ///< `influences` per vertex, of the skin
    std::vector<float> weights;         ///< beside `joints`, not negative
  };
  std::vector<std::shared_ptr<const Shape>> shapes;

  struct Deformed {
    std::uint32_t mesh = 0, shape = 0;
    std::int32_t skin = kNone;
    std::uint32_t node = 0;  ///< whose weights count
  };
  std::vector<Deformed> deformed;  ///< by rising mesh

  struct Placed {
    std::uint32_t instance = 0, node = 0;
  };
  std::vector<Placed> placed;  ///< not those of skins, which joints place
  struct Seeing {
    std::uint32_t camera = 0, node = 0;
  };
  std::vector<Seeing> cameras;
  struct Lamp {
    std::uint32_t light = 0, node = 0;
    Light of_node{};  ///< as if the node's axes were the world's
  };
  std::vector<Lamp> lamps;

  enum class Path : std::uint8_t { translation, rotation, scale, weights };
  enum class Interpolation : std::uint8_t { step, linear, cubic_spline };
  using Floats = std::shared_ptr<const std::vector<float>>;

  /// Keys of a node's property. A key has `width` numbers; of a cubic spline three times as many:
  /// tangent in, value, tangent out.
  struct Track {
    std::uint32_t node = 0;
    Path path = Path::translation;
    Interpolation interpolation = Interpolation::linear;
    std::size_t width = 3;
    Floats times, values;  ///< times rise, at least one
  };
  struct Clip {
    std::vector<Track> tracks;
  };
  std::vector<Clip> clips;  ///< one per animation
};

/// Places a camera at a node, looking along its −z, +y up.
void look_from(Camera& camera, const Mat4d& node_to_world);

/// The matrix from each node to the file's space.
[[nodiscard]] std::vector<Mat4d> to_root(const std::vector<Rig::Node>& nodes,
                                         const std::vector<std::uint32_t>& parents_first);

}  // namespace rastrum
