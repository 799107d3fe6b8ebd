// SPDX-License-Identifier: BSD-3-Clause
// The Embree peer; see the header. Compiled with -O3 (bench/CMakeLists.txt). A packet is shaded in
// plain loops over its rays, cloned for AVX2 and AVX-512 and chosen at load time.
#include "embree_peer.hpp"

#include <embree3/rtcore.h>
#include <tbb/blocked_range2d.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace rastrum::bench {
namespace {

/// Packets as wide as the machine traces natively. On AVX2 (Zen 3) the bunny at 1024² took 28.7 ms
/// with 16 rays as 2 × 8, and 21.9 with 8.
struct Packet8 {
  using RayHit = RTCRayHit8;
  static constexpr int kCount = 8, kWidth = 4;
  static constexpr auto intersect = rtcIntersect8;
};
struct Packet16 {
  using RayHit = RTCRayHit16;
  static constexpr int kCount = 16, kWidth = 4;
  static constexpr auto intersect = rtcIntersect16;
};
constexpr int kMaxPacket = 16;
constexpr int kTile = 16;  ///< pixels a side of the smallest task

/// Inputs and outputs of shading, a value per ray.
struct Shading {
  alignas(64) float nx[kMaxPacket], ny[kMaxPacket], nz[kMaxPacket];  ///< towards the viewer or away
  alignas(64) float dx[kMaxPacket], dy[kMaxPacket], dz[kMaxPacket];  ///< direction of the ray
  alignas(64) std::int32_t hit[kMaxPacket];                          ///< 0 or 1
  alignas(64) std::uint32_t rgba[kMaxPacket];                        ///< bytes in memory order
};

/// The project's `phong`, base (0.8, 0.7, 0.6), for `count` rays.
#if defined(__x86_64__)
__attribute__((target_clones("avx512f", "avx2", "default")))
#endif
void shade(Shading& s, int count) {
  const float light_scale = 1 / std::sqrt(0.4F * 0.4F + 0.6F * 0.6F + 1.0F);
  const float lx = 0.4F * light_scale, ly = 0.6F * light_scale, lz = light_scale;
  for (int i = 0; i < count; ++i) {
    const float n_scale = 1 / std::sqrt(s.nx[i] * s.nx[i] + s.ny[i] * s.ny[i] + s.nz[i] * s.nz[i]);
    const float v_scale = -1 / std::sqrt(s.dx[i] * s.dx[i] + s.dy[i] * s.dy[i] + s.dz[i] * s.dz[i]);
    const float vx = s.dx[i] * v_scale, vy = s.dy[i] * v_scale, vz = s.dz[i] * v_scale;
    const float facing = s.nx[i] * vx + s.ny[i] * vy + s.nz[i] * vz;
    const float turned = facing < 0 ? -n_scale : n_scale;
    const float nx = s.nx[i] * turned, ny = s.ny[i] * turned, nz = s.nz[i] * turned;
    const float hx = lx + vx, hy = ly + vy, hz = lz + vz;
    const float h_scale = 1 / std::sqrt(hx * hx + hy * hy + hz * hz);
    const float n_dot_l = nx * lx + ny * ly + nz * lz;
    const float n_dot_h = (nx * hx + ny * hy + nz * hz) * h_scale;
    const float diffuse = 0.1F + 0.8F * (n_dot_l > 0 ? n_dot_l : 0.0F);
    float p = n_dot_h > 0 ? n_dot_h : 0.0F;
    p = p * p;
    p = p * p;
    p = p * p;
    p = p * p;
    p = 0.3F * (p * p);
    const auto to_byte = [](float value) {
      const float clamped = value < 1 ? value : 1.0F;
      return static_cast<std::int32_t>(clamped * 255.0F + 0.5F);
    };
    const std::int32_t r = to_byte(0.8F * diffuse + p);
    const std::int32_t g = to_byte(0.7F * diffuse + p);
    const std::int32_t b = to_byte(0.6F * diffuse + p);
    const std::int32_t pixel = r | g << 8 | b << 16 | static_cast<std::int32_t>(0xff000000U);
    s.rgba[i] = static_cast<std::uint32_t>(s.hit[i] != 0 ? pixel : 0);
  }
}

/// The rays of a camera: direction = corner + x · across + y · down at pixel centre (x, y). Its
/// length along the view is 1, so the ray parameter is the view depth.
struct Rays {
  Vec3 origin, corner, across, down;
  float near_depth, far_depth;
};

Rays rays_of(const Camera& camera, int width, int height) {
  if (camera.orthographic)
    throw Error(Errc::invalid_argument, "EmbreePeer: only perspective cameras");
  const Mat4d view = world_to_camera(camera);
  const double tangent = std::tan(static_cast<double>(camera.fov_rad) / 2);
  const double pixel = 2 * tangent / std::min(width, height);
  const auto world = [&](double x, double y, double z) {
    const auto axis = [&](int i) {
      return static_cast<float>(x * view.m[0][i] + y * view.m[1][i] + z * view.m[2][i]);
    };
    return Vec3{axis(0), axis(1), axis(2)};
  };
  return {Vec3(camera.eye),   world(-pixel * width / 2, pixel * height / 2, -1),
          world(pixel, 0, 0), world(0, -pixel, 0),
          camera.near_plane,  camera.far_plane};
}

}  // namespace

struct EmbreePeer::Impl {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  tbb::task_arena arena;
  std::vector<Vec3> positions, normals;
  std::vector<Vec4> balls;  ///< of spheres and tubes: place and radius
  std::vector<std::uint8_t> neighbours;
  std::vector<std::uint32_t> indices;
  std::size_t vertex_count = 0;
  RTCGeometryType type = RTC_GEOMETRY_TYPE_TRIANGLE;
  bool native16 = false;

  explicit Impl(int threads) : arena(threads) {
    device = rtcNewDevice(("threads=" + std::to_string(threads)).c_str());
    if (device == nullptr)
      throw Error(Errc::no_device,
                  "Embree gives no device, error " + std::to_string(rtcGetDeviceError(nullptr)));
    native16 = rtcGetDeviceProperty(device, RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED) != 0;
  }
  ~Impl() {
    if (scene != nullptr) rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  void build() {
    if (scene != nullptr) rtcReleaseScene(scene);
    scene = rtcNewScene(device);
    RTCGeometry geometry = rtcNewGeometry(device, type);
    const auto share = [&](RTCBufferType buffer, RTCFormat format, const auto& values,
                           std::size_t bytes, std::size_t count) {
      rtcSetSharedGeometryBuffer(geometry, buffer, 0, format, values.data(), 0, bytes, count);
    };
    if (type == RTC_GEOMETRY_TYPE_TRIANGLE) {
      share(RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, positions, sizeof(Vec3), vertex_count);
      share(RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, indices, 3 * sizeof(std::uint32_t),
            indices.size() / 3);
    } else {
      share(RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT4, balls, sizeof(Vec4), balls.size());
    }
    if (type == RTC_GEOMETRY_TYPE_ROUND_LINEAR_CURVE) {
      share(RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT, indices, sizeof(std::uint32_t), indices.size());
      share(RTC_BUFFER_TYPE_FLAGS, RTC_FORMAT_UCHAR, neighbours, 1, neighbours.size());
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
    arena.execute([&] { rtcJoinCommitScene(scene); });
    if (const RTCError e = rtcGetDeviceError(device); e != RTC_ERROR_NONE)
      throw Error(e == RTC_ERROR_OUT_OF_MEMORY ? Errc::out_of_memory : Errc::unsupported,
                  "Embree error " + std::to_string(e) + " in build");
  }

  /// Changes the geometry's type. Releases the scene, which borrows the buffers.
  void become(RTCGeometryType to) {
    if (scene != nullptr) rtcReleaseScene(scene);
    scene = nullptr;
    type = to;
  }
  void set_balls(std::span<const Vec3> places, std::span<const float> radii) {
    balls.clear();
    for (std::size_t i = 0; i < places.size(); ++i)
      balls.push_back({places[i].x, places[i].y, places[i].z, radii[i]});
  }

  template <class Packet>
  void trace_packet(RTCIntersectContext& context, const Rays& rays, int x0, int y0,
                    const ImageView<Rgba8>& image) const {
    constexpr int kCount = Packet::kCount, kWidth = Packet::kWidth;
    alignas(64) std::int32_t valid[kMaxPacket];
    typename Packet::RayHit packet;
    Shading s;
    for (int i = 0; i < kCount; ++i) {
      const int x = x0 + i % kWidth, y = y0 + i / kWidth;
      const float cx = static_cast<float>(x) + 0.5F, cy = static_cast<float>(y) + 0.5F;
      valid[i] = x < image.width && y < image.height ? -1 : 0;
      packet.ray.org_x[i] = rays.origin.x;
      packet.ray.org_y[i] = rays.origin.y;
      packet.ray.org_z[i] = rays.origin.z;
      packet.ray.dir_x[i] = s.dx[i] = rays.corner.x + cx * rays.across.x + cy * rays.down.x;
      packet.ray.dir_y[i] = s.dy[i] = rays.corner.y + cx * rays.across.y + cy * rays.down.y;
      packet.ray.dir_z[i] = s.dz[i] = rays.corner.z + cx * rays.across.z + cy * rays.down.z;
      packet.ray.tnear[i] = rays.near_depth;
      packet.ray.tfar[i] = rays.far_depth;
      packet.ray.time[i] = 0;
      packet.ray.mask[i] = ~0U;
      packet.ray.id[i] = 0;
      packet.ray.flags[i] = 0;
      packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
      packet.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
    }
    Packet::intersect(valid, scene, &context, &packet);
    bool any = false;
    for (int i = 0; i < kCount; ++i) {
      s.hit[i] = packet.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID ? 1 : 0;
      if (s.hit[i] == 0) {
        s.nx[i] = s.ny[i] = s.nz[i] = 1;
        continue;
      }
      any = true;
      if (type != RTC_GEOMETRY_TYPE_TRIANGLE) {
        s.nx[i] = packet.hit.Ng_x[i];
        s.ny[i] = packet.hit.Ng_y[i];
        s.nz[i] = packet.hit.Ng_z[i];
        continue;
      }
      const std::uint32_t* corner = &indices[3 * static_cast<std::size_t>(packet.hit.primID[i])];
      const float u = packet.hit.u[i], v = packet.hit.v[i];
      const Vec3 n =
          normals[corner[0]] * (1 - u - v) + normals[corner[1]] * u + normals[corner[2]] * v;
      s.nx[i] = n.x;
      s.ny[i] = n.y;
      s.nz[i] = n.z;
    }
    if (any)
      shade(s, kCount);
    else
      std::fill_n(s.rgba, kCount, 0U);
    for (int i = 0; i < kCount; ++i) {
      if (valid[i] == 0) continue;
      const std::uint32_t c = s.rgba[i];
      image(x0 + i % kWidth, y0 + i / kWidth) = {
          static_cast<std::uint8_t>(c), static_cast<std::uint8_t>(c >> 8),
          static_cast<std::uint8_t>(c >> 16), static_cast<std::uint8_t>(c >> 24)};
    }
  }

  template <class Packet>
  void trace_tile(const Rays& rays, const tbb::blocked_range2d<int>& tiles,
                  const ImageView<Rgba8>& image) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    for (int ty = tiles.rows().begin(); ty != tiles.rows().end(); ++ty)
      for (int tx = tiles.cols().begin(); tx != tiles.cols().end(); ++tx)
        for (int y = ty * kTile; y < std::min((ty + 1) * kTile, image.height);
             y += Packet::kCount / Packet::kWidth)
          for (int x = tx * kTile; x < std::min((tx + 1) * kTile, image.width); x += Packet::kWidth)
            trace_packet<Packet>(context, rays, x, y, image);
  }
};

EmbreePeer::EmbreePeer(int threads) : impl_(std::make_unique<Impl>(threads)) {}
EmbreePeer::~EmbreePeer() = default;

std::string EmbreePeer::description() const {
  return std::string("Embree " RTC_VERSION_STRING ", packets of ") + (impl_->native16 ? "16" : "8");
}

void EmbreePeer::set_mesh(const MeshView& mesh) {
  if (!mesh.normals.indices.empty() || mesh.normals.values.size() != mesh.positions.size())
    throw Error(Errc::invalid_argument, "EmbreePeer: normals must share the positions' indices");
  Impl& s = *impl_;
  s.become(RTC_GEOMETRY_TYPE_TRIANGLE);
  s.vertex_count = mesh.positions.size();
  const auto copy = [](auto& to, const auto& view) {
    to.assign(view.packed().begin(), view.packed().end());
  };
  copy(s.positions, mesh.positions);
  s.positions.emplace_back();  // Embree reads 16 bytes at each vertex
  copy(s.normals, mesh.normals.values);
  copy(s.indices, mesh.indices);
  if (mesh.indices.empty())
    for (std::size_t i = 0; i < s.vertex_count / 3 * 3; ++i)
      s.indices.push_back(static_cast<std::uint32_t>(i));
}

void EmbreePeer::set_spheres(std::span<const Vec3> centers, std::span<const float> radii) {
  impl_->become(RTC_GEOMETRY_TYPE_SPHERE_POINT);
  impl_->set_balls(centers, radii);
}

void EmbreePeer::set_tubes(std::span<const Vec3> positions, std::span<const float> radii,
                           std::span<const std::uint32_t> offsets) {
  Impl& s = *impl_;
  s.become(RTC_GEOMETRY_TYPE_ROUND_LINEAR_CURVE);
  s.set_balls(positions, radii);
  s.indices.clear();
  s.neighbours.clear();
  for (std::size_t line = 0; line + 1 < offsets.size(); ++line)
    for (std::uint32_t i = offsets[line]; i + 1 < offsets[line + 1]; ++i) {
      const bool is_first = i == offsets[line], is_last = i + 2 == offsets[line + 1];
      s.indices.push_back(i);
      s.neighbours.push_back(
          static_cast<std::uint8_t>((is_first ? 0 : RTC_CURVE_FLAG_NEIGHBOR_LEFT) |
                                    (is_last ? 0 : RTC_CURVE_FLAG_NEIGHBOR_RIGHT)));
    }
}

void EmbreePeer::build() {
  impl_->build();
}

void EmbreePeer::trace(const Camera& camera, ImageView<Rgba8> image) {
  Impl& s = *impl_;
  if (s.scene == nullptr) throw Error(Errc::invalid_argument, "EmbreePeer: build comes first");
  const Rays rays = rays_of(camera, image.width, image.height);
  const int columns = (image.width + kTile - 1) / kTile;
  const int rows = (image.height + kTile - 1) / kTile;
  s.arena.execute([&] {
    tbb::parallel_for(tbb::blocked_range2d<int>(0, rows, 0, columns), [&](const auto& tiles) {
      if (s.native16)
        s.trace_tile<Packet16>(rays, tiles, image);
      else
        s.trace_tile<Packet8>(rays, tiles, image);
    });
  });
}

}  // namespace rastrum::bench
