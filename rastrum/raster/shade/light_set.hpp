// SPDX-License-Identifier: BSD-3-Clause
// A frame's lights as shading reads them, rounded to float32 once. Lights of the camera are placed
// in the world, and light from all around is summed.
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

/// Shader::classic reads this of a light. Colours are display values.
struct ClassicTerm {
  Vec3 ambient, diffuse, specular;
  bool fades = false;    ///< by `fade`, and a spot by `cutoff` and `sixteenths`
  Vec3 fade;             ///< the light is divided by x + y d + z d²
  float cutoff = 0;      ///< of a spot: the cosine of its half angle
  float sixteenths = 0;  ///< of a spot: its exponent is so many sixteenths
};

/// A light with a direction or a place.
struct LightTerm {
  enum class Kind : std::uint8_t { directional, point, spot };
  Kind kind = Kind::directional;
  /// The unit direction to it or, with a position, that relative to LightSet's origin.
  Vec3 place;
  Vec3 radiance;                          ///< E / π, linear, at a distance of 1
  float inv_range2 = 0;                   ///< 1 / range²
  Vec3 axis;                              ///< of a spot: its unit direction
  float cone_scale = 0, cone_offset = 0;  ///< saturate(cos · scale + offset)²
  ClassicTerm classic;
  std::span<const ShadowMap> shadow;  ///< the finest first; empty: no shadows
};

/// A linear function of pixel and depth, for a point's place.
struct PixelPlane {
  float constant = 0, x = 0, y = 0, depth = 0;
};

/// An environment and its orientation.
struct Surrounding {
  EnvironmentMap map;
  Vec3 x, y, z;  ///< its axes in the world: it sees a world direction d as (x·d, y·d, z·d)
  Vec3 color;

  /// Light from world direction `d`, of any length, blurred by `roughness`.
  [[nodiscard]] RASTRUM_HD Vec3 at(Vec3 d, float roughness) const {
    return color * map.at({dot(x, d), dot(y, d), dot(z, d)}, roughness);
  }
};

/// Light that matt surfaces gather from environments: for a normal n it is mean + rise · n + bend ·
/// (xx, yy, zz, xy, yz, zx) of n.
struct GatheredLight {
  Vec3 mean, rise[3], bend[6];
};

struct LightSet {
  std::span<const LightTerm> terms;
  std::span<const Surrounding> surroundings;
  GatheredLight gathered;   ///< from all environments
  bool has_places = false;  ///< some term needs the surface's place
  /// Light from all around: direction n brings ambient + rise · n, by channel.
  Vec3 ambient, rise_x, rise_y, rise_z;
  /// A sample's world place relative to an origin near the eye: (x, y, z) / w of its pixel
  /// coordinates and depth, for any camera.
  PixelPlane x, y, z, w;
};

/// The depths of a part of the scene that a light sees.
struct LightPicture {
  ImageView<const float> depth{};  ///< reversed
  Mat4d world_to_clip;
  double texel = 0;  ///< its width at w = 1
};
/// A light's pictures, the finest first; empty: no shadows.
using LightShadow = std::span<const LightPicture>;

/// Owns a frame's LightSet.
class FrameLights {
 public:
  /// `lights`: checked by check_lights; their environments must outlive this. `shadows`: one for
  /// each light, with pictures that must outlive this; empty: none.
  /// `classic`: for Shader::classic, whose colours are display values.
  FrameLights(std::span<const Light> lights, std::span<const LightShadow> shadows,
              const Camera& camera, int width, int height, bool classic = false);
  FrameLights(const FrameLights&) = delete;
  FrameLights& operator=(const FrameLights&) = delete;
  [[nodiscard]] const LightSet& set() const { return set_; }

  /// An environment's axes in the world, of unit length.
  struct Axes {
    Vec3d x, y, z;
  };

 private:
  void add_environment(const EnvironmentLight& light, const Axes& axes, Vec3 color);

  std::vector<LightTerm> terms_;
  std::vector<ShadowMap> maps_;  ///< terms point into it
  std::vector<Surrounding> surroundings_;
  LightSet set_;
};

}  // namespace rastrum::raster
