// SPDX-License-Identifier: BSD-3-Clause
// A frame's lights as shading reads them: rounded to float32 once. Lights of the camera are placed
// in the world, and the light that comes from all around is summed up.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <rastrum/camera.hpp>
#include <rastrum/image.hpp>
#include <rastrum/light.hpp>
#include <rastrum/mat.hpp>
#include <rastrum/raster/shade/shadow_map.hpp>
#include <rastrum/scene/environment_map.hpp>
#include <rastrum/vec.hpp>

namespace rastrum::raster {

/// A light that comes from somewhere.
struct LightTerm {
  enum class Kind : std::uint8_t { directional, point, spot };
  Kind kind = Kind::directional;
  /// The unit direction to it; with a position that, from the origin of LightSet's places.
  Vec3 place;
  Vec3 radiance;                          ///< E / π, linear, where it shines at a distance of 1
  float inv_range2 = 0;                   ///< 1 / range²
  Vec3 axis;                              ///< of a spot, in which it shines, of unit length
  float cone_scale = 0, cone_offset = 0;  ///< saturate(cos · scale + offset)²
  std::span<const ShadowMap> shadow;      ///< the finest first; empty: no shadows
};

/// A linear function of pixel and depth, as a point's place is found by.
struct PixelPlane {
  float constant = 0, x = 0, y = 0, depth = 0;
};

/// An environment, and how it stands in the world.
struct Surrounding {
  EnvironmentMap map;
  Vec3 x, y, z;  ///< its axes in the world: a direction d of the world is (x·d, y·d, z·d) in it
  Vec3 color;

  /// The light from direction `d` of the world, of any length, blurred by `roughness`.
  [[nodiscard]] RASTRUM_HD Vec3 at(Vec3 d, float roughness) const {
    return color * map.at({dot(x, d), dot(y, d), dot(z, d)}, roughness);
  }
};

/// The light that matt surfaces gather from environments. For a normal n it is mean + rise · n +
/// bend · (xx, yy, zz, xy, yz, zx) of n.
struct GatheredLight {
  Vec3 mean, rise[3], bend[6];
};

struct LightSet {
  std::span<const LightTerm> terms;
  std::span<const Surrounding> surroundings;
  GatheredLight gathered;   ///< from all of them
  bool has_places = false;  ///< some term needs a surface's place
  /// Light from all around: a direction n brings ambient + rise · n (each channel has its own).
  Vec3 ambient, rise_x, rise_y, rise_z;
  /// A sample's place in the world, from an origin near the eye: (x, y, z) / w of its pixel
  /// coordinates and its depth. This form serves any camera.
  PixelPlane x, y, z, w;
};

/// The depths that a light sees of a part of the scene.
struct LightPicture {
  ImageView<const float> depth{};  ///< reversed
  Mat4d world_to_clip;
  double texel = 0;  ///< its width where w is 1
};
/// The pictures of a light, the finest first; empty: it has no shadows.
using LightShadow = std::span<const LightPicture>;

/// The owner of a frame's LightSet.
class FrameLights {
 public:
  /// Lights that check_lights passes, seen by `camera`; their environments must outlive this.
  /// `shadows`: one a light, whose pictures must outlive this; empty: there are none.
  FrameLights(std::span<const Light> lights, std::span<const LightShadow> shadows,
              const Camera& camera, int width, int height);
  FrameLights(const FrameLights&) = delete;
  FrameLights& operator=(const FrameLights&) = delete;
  [[nodiscard]] const LightSet& set() const { return set_; }

  /// The axes of an environment: in the world, of unit length.
  struct Axes {
    Vec3d x, y, z;
  };

 private:
  void add_environment(const EnvironmentLight& light, const Axes& axes, Vec3 color);

  std::vector<LightTerm> terms_;
  std::vector<ShadowMap> maps_;  ///< terms point to them
  std::vector<Surrounding> surroundings_;
  LightSet set_;
};

}  // namespace rastrum::raster
