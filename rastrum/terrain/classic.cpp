// The original program (Macke's, paper 3, section 2.3), bit for bit: float64 throughout, positions
// accumulated along a slice, 240 rows whatever the resolution, heights truncated toward zero.
// A map of another size than 1024² repeats, mirrors or ends by the floor of the coordinates. Holes
// draw nothing.
#include <cmath>
#include <limits>
#include <vector>

#include <rastrum/terrain/methods.hpp>

namespace rastrum::terrain {

Counts draw_classic_reference(const Terrain& terrain, const TerrainOptions& options,
                              const TerrainCamera& camera, const TerrainTargets& targets) {
  const int width = options.width, height = options.height;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      if (!targets.color8.empty()) targets.color8(x, y) = options.sky;
      if (!targets.depth.empty()) targets.depth(x, y) = std::numeric_limits<float>::infinity();
    }
  Counts counts;
  std::vector<int> hidden(static_cast<std::size_t>(width), height);
  const double sin = std::sin(camera.angle_rad), cos = std::cos(camera.angle_rad);
  double dz = 1;
  for (double z = 1; z < options.distance; dz += 0.005, z += dz) {
    double x = -cos * z - sin * z, y = sin * z - cos * z;
    const double dx = (cos * z - sin * z - x) / width, dy = (-sin * z - cos * z - y) / width;
    x += camera.x;
    y += camera.y;
    const double inverse = 1 / z * 240;
    for (int i = 0; i < width; ++i, x += dx, y += dy) {
      int& below = hidden[static_cast<std::size_t>(i)];
      if (below == 0) continue;
      ++counts.samples;
      const double ground = terrain.height_at(x, y, options.tiling);
      const double row = (camera.altitude - ground) * inverse + camera.horizon_px;
      if (!(row < below)) continue;
      const int top = row > 0 ? static_cast<int>(row) : 0;
      ++counts.visible;
      const Rgba8 color = terrain.color_at(x, y, options.tiling);
      for (; below > top; --below) {
        if (!targets.color8.empty()) targets.color8(i, below - 1) = color;
        if (!targets.depth.empty()) targets.depth(i, below - 1) = static_cast<float>(z);
      }
    }
  }
  return counts;
}

}  // namespace rastrum::terrain
