// SPDX-License-Identifier: BSD-3-Clause
// Poses: a rig's nodes at a moment, then all that depends on them. Computed in float64 in the order
// written here and rounded to float32 once; only exact functions of libm are used.
#include <algorithm>
#include <cmath>
#include <string>

#include <rastrum/core/float32.hpp>
#include <rastrum/core/float_scope.hpp>
#include <rastrum/core/vectors.hpp>
#include <rastrum/error.hpp>
#include <rastrum/scene.hpp>
#include <rastrum/scene/rig.hpp>

namespace rastrum {
namespace {

/// The moment of an animation that repeats.
double moment_of(double seconds, double duration_s) {
  if (!(seconds > 0 && duration_s > 0)) return 0;
  const double rest = std::fmod(seconds, duration_s);  // exact by its definition
  return rest > 0 ? rest : duration_s;
}

Quaternion quaternion(const double* xyzw) {
  return {xyzw[3], xyzw[0], xyzw[1], xyzw[2]};
}

/// The `width` numbers of a track at a moment; outside its keys, those of the nearest.
void sample(const Rig::Track& track, double moment, double* to) {
  const std::vector<float>& times = *track.times;
  const float* const values = track.values->data();
  const std::size_t width = track.width;
  const bool cubic = track.interpolation == Rig::Interpolation::cubic_spline;
  // Number i of key k. A cubic spline's key has parts: 0 the tangent in, 1 the value, 2 the tangent
  // out.
  const auto number = [&](std::size_t k, std::size_t part, std::size_t i) -> double {
    return values[cubic ? (3 * k + part) * width + i : k * width + i];
  };
  const auto after = std::upper_bound(times.begin(), times.end(), moment,
                                      [](double m, float time) { return m < double{time}; });
  const auto next = static_cast<std::size_t>(after - times.begin());
  const std::size_t k = next == 0 ? 0 : next - 1;
  if (next == 0 || next == times.size() || track.interpolation == Rig::Interpolation::step) {
    for (std::size_t i = 0; i < width; ++i) to[i] = number(k, 1, i);
    return;
  }
  const double span = double{times[next]} - double{times[k]};
  const double s = (moment - double{times[k]}) / span;
  if (cubic) {
    // Hermite's polynomials; tangents are per second.
    const double s2 = s * s, s3 = s2 * s;
    const double from = 2 * s3 - 3 * s2 + 1, out = span * (s3 - 2 * s2 + s);
    const double into = 3 * s2 - 2 * s3, in = span * (s3 - s2);
    for (std::size_t i = 0; i < width; ++i)
      to[i] = from * number(k, 1, i) + out * number(k, 2, i) + into * number(next, 1, i) +
              in * number(next, 0, i);
  } else if (track.path == Rig::Path::rotation) {
    double a[4], b[4];
    for (std::size_t i = 0; i < 4; ++i) {
      a[i] = number(k, 1, i);
      b[i] = number(next, 1, i);
    }
    const Quaternion q = slerp(normalize(quaternion(a)), normalize(quaternion(b)), s);
    to[0] = q.x;
    to[1] = q.y;
    to[2] = q.z;
    to[3] = q.w;
  } else {
    for (std::size_t i = 0; i < width; ++i)
      to[i] = (1 - s) * number(k, 1, i) + s * number(next, 1, i);
  }
}

void apply(const Rig::Track& track, double moment, Rig::Node& node) {
  if (track.path == Rig::Path::weights) {
    node.weights.resize(track.width);
    return sample(track, moment, node.weights.data());
  }
  double v[4];
  sample(track, moment, v);
  switch (track.path) {
    case Rig::Path::translation:
      node.translation = {v[0], v[1], v[2]};
      break;
    case Rig::Path::scale:
      node.scale = {v[0], v[1], v[2]};
      break;
    default:
      node.rotation = normalize(quaternion(v));
  }
}

/// By an affine matrix's inverse transpose: the cofactors, which exist without an inverse, times
/// the determinant's sign.
Vec3d turned_normal(const Mat4d& a, const Vec3d& n) {
  const Vec3d x = row_of(a, 0), y = row_of(a, 1), z = row_of(a, 2);
  const Vec3d yz = cross(y, z), zx = cross(z, x), xy = cross(x, y);
  const double sign = dot(x, yz) < 0 ? -1 : 1;
  return {sign * dot(yz, n), sign * dot(zx, n), sign * dot(xy, n)};
}

/// For each joint, the matrix from the shape as bound to where the joint has it.
std::vector<Mat4d> joint_matrices(const Rig::Skin& skin, const std::vector<Mat4d>& to_file) {
  std::vector<Mat4d> r;
  for (std::size_t j = 0; j < skin.joints.size(); ++j)
    r.push_back(to_file[skin.joints[j]] * skin.inverse_bind[j]);
  return r;
}

/// The mean of a vertex's joints. Weights need not sum to 1; without any, the first joint counts.
Mat4d blend(const Rig::Shape& shape, std::size_t vertex, const std::vector<Mat4d>& joints) {
  const std::uint32_t* const joint = &shape.joints[vertex * shape.influences];
  const float* const weight = &shape.weights[vertex * shape.influences];
  double sum = 0;
  for (std::size_t k = 0; k < shape.influences; ++k) sum += double{weight[k]};
  if (!(sum > 0)) return joints[joint[0]];
  Mat4d r;
  for (std::size_t k = 0; k < shape.influences; ++k) {
    if (weight[k] == 0) continue;
    const Mat4d& m = joints[joint[k]];
    const double share = double{weight[k]} / sum;
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 4; ++column) r.m[row][column] += share * m.m[row][column];
  }
  return r;
}

/// Morphing first, then the skin. `joints`: the skin's; null: none.
void deform(const Rig::Shape& shape, const std::vector<double>& weights,
            const std::vector<Mat4d>* joints, Mesh& mesh) {
  struct Active {
    const Rig::Shape::Target* target;
    double weight;
  };
  std::vector<Active> active;
  for (std::size_t t = 0; t < std::min(shape.targets.size(), weights.size()); ++t)
    if (weights[t] != 0) active.push_back({&shape.targets[t], weights[t]});

  mesh.positions = shape.positions;
  mesh.normals.values = shape.normals;
  mesh.normals.indices.clear();
  if (active.empty() && joints == nullptr) return;
  for (std::size_t i = 0; i < shape.positions.size(); ++i) {
    const Mat4d skin = joints == nullptr ? Mat4d{} : blend(shape, i, *joints);
    Vec3d p = Vec3d(shape.positions[i]);
    for (const Active& a : active)
      if (!a.target->positions.empty()) p = p + Vec3d(a.target->positions[i]) * a.weight;
    mesh.positions[i] = Vec3(joints == nullptr ? p : moved_by(skin, p));
    if (shape.normals.empty()) continue;
    Vec3d n = Vec3d(shape.normals[i]);
    for (const Active& a : active)
      if (!a.target->normals.empty()) n = n + Vec3d(a.target->normals[i]) * a.weight;
    if (joints != nullptr) n = turned_normal(skin, n);
    const double l = length(n);
    mesh.normals.values[i] = l > 0 ? Vec3(n * (1 / l)) : Vec3{};
  }
}

/// `clip`: null at rest.
void pose(Scene& scene, const Motion& motion, const Rig::Clip* clip, double moment,
          std::vector<std::uint32_t>& written) {
  const FloatScope floats;
  const Rig& rig = *motion.rig;
  std::vector<Rig::Node> nodes = rig.nodes;
  if (clip != nullptr)
    for (const Rig::Track& track : clip->tracks) apply(track, moment, nodes[track.node]);
  const std::vector<Mat4d> to_file = to_root(nodes, rig.parents_first);
  for (const Rig::Placed& p : rig.placed)
    scene.instances[motion.first_instance + p.instance].object_to_world =
        motion.to_world * to_file[p.node];
  for (const Rig::Seeing& c : rig.cameras)
    look_from(scene.cameras[motion.first_camera + c.camera], to_file[c.node]);
  for (const Rig::Lamp& l : rig.lamps)
    scene.lights[motion.first_light + l.light] =
        placed(l.of_node, motion.to_world * to_file[l.node]);

  std::vector<std::vector<Mat4d>> joints(rig.skins.size());
  for (const Rig::Deformed& d : rig.deformed) {
    std::vector<Mat4d>* const skin =
        d.skin == Rig::kNone ? nullptr : &joints[static_cast<std::size_t>(d.skin)];
    if (skin != nullptr && skin->empty())
      *skin = joint_matrices(rig.skins[static_cast<std::size_t>(d.skin)], to_file);
    const std::uint32_t mesh = motion.first_mesh + d.mesh;
    const Rig::Shape& shape = *rig.shapes[d.shape];
    const std::vector<double>& weights = nodes[d.node].weights;
    deform(shape, weights.empty() ? shape.rest_weights : weights, skin, scene.meshes[mesh]);
    written.push_back(mesh);
  }
}

}  // namespace

Mat4d Rig::Node::local() const {
  if (has_matrix) return matrix;
  Mat4d r = rastrum::rotation(rotation);
  const double s[3] = {scale.x, scale.y, scale.z};
  const double t[3] = {translation.x, translation.y, translation.z};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) r.m[i][j] *= s[j];
    r.m[i][3] = t[i];
  }
  return r;
}

void look_from(Camera& camera, const Mat4d& node_to_world) {
  const auto column = [&](int k, double sign) {
    return in_float32(Vec3d{node_to_world.m[0][k], node_to_world.m[1][k], node_to_world.m[2][k]} *
                      sign);
  };
  camera.eye = column(3, 1);
  const Vec3 forward = normalize(Vec3(column(2, -1)));
  camera.target = Vec3(camera.eye) + forward;
  camera.up = normalize(Vec3(column(1, 1)));
}

std::vector<Mat4d> to_root(const std::vector<Rig::Node>& nodes,
                           const std::vector<std::uint32_t>& parents_first) {
  std::vector<Mat4d> r(nodes.size());
  for (const std::uint32_t n : parents_first) {
    const std::int32_t parent = nodes[n].parent;
    r[n] = (parent == Rig::kNone ? Mat4d::identity() : r[static_cast<std::size_t>(parent)]) *
           nodes[n].local();
  }
  return r;
}

std::vector<std::uint32_t> pose(Scene& scene, double seconds, std::size_t animation) {
  const FloatScope floats;
  if (!std::isfinite(seconds)) throw Error(Errc::invalid_argument, "pose: seconds must be finite");
  std::size_t most = 0;
  for (const Motion& m : scene.motions) most = std::max(most, m.animations.size());
  if (!scene.motions.empty() && animation >= most)
    throw Error(Errc::invalid_argument, "pose: there is no animation " + std::to_string(animation) +
                                            ", but " + std::to_string(most));
  std::vector<std::uint32_t> written;
  for (const Motion& m : scene.motions) {
    const bool has = animation < m.animations.size();
    pose(scene, m, has ? &m.rig->clips[animation] : nullptr,
         has ? moment_of(seconds, m.animations[animation].duration_s) : 0, written);
  }
  return written;
}

std::vector<std::uint32_t> pose_at_rest(Scene& scene) {
  const FloatScope floats;
  std::vector<std::uint32_t> written;
  for (const Motion& m : scene.motions) pose(scene, m, nullptr, 0, written);
  return written;
}

}  // namespace rastrum
