// SPDX-License-Identifier: BSD-3-Clause
// Turns an equirectangular picture into the data that shading reads. The light that matt surfaces
// gather becomes nine numbers per channel (Ramamoorthi and Hanrahan 2001). The light that surfaces
// of eight roughnesses mirror is filtered by their distribution of facets, as if seen from straight
// above (Karis 2013). Rows have their own sums, added in order, so threads change no bit.
#include <rastrum/environment.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include <rastrum/core/elementary.hpp>
#include <rastrum/core/float_scope.hpp>
#include <rastrum/core/number_text.hpp>
#include <rastrum/core/view_rows.hpp>
#include <rastrum/error.hpp>
#include <rastrum/parallel/exec.hpp>
#include <rastrum/scene/environment_map.hpp>

namespace rastrum {
namespace {

using environment_detail::Data;
using environment_detail::Gathered;

constexpr double kPi = std::numbers::pi;
constexpr int kSharpest = 2048;  ///< texels of level 0 per side, at most
/// Sizes of the levels: a lobe of level 1 is 2° wide, a texel of 128 about 1°. Smooth levels need
/// 64 because the map has folds.
constexpr int kSizes[EnvironmentMap::kLevels] = {0, 128, 128, 64, 64, 64, 64, 64};
constexpr int kSourceRows = 128;  ///< of what rough surfaces mirror

void check_picture(ImageView<const Vec3> picture) {
  const auto fail = [](const std::string& what) {
    throw Error(Errc::invalid_argument, "environment: " + what);
  };
  if (picture.empty() || picture.height < 1 || picture.width != 2 * picture.height)
    fail("an equirectangular picture is twice as wide as high, this one is " +
         std::to_string(picture.width) + "x" + std::to_string(picture.height));
  check_stride(picture, "environment");
  const auto is_light = [](float v) { return v >= 0 && v <= 1e12F; };
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) {
      const Vec3 c = picture(x, y);
      if (!is_light(c.x) || !is_light(c.y) || !is_light(c.z))
        fail("pixel (" + std::to_string(x) + ", " + std::to_string(y) + ") is " + number_text(c.x) +
             " " + number_text(c.y) + " " + number_text(c.z) + "; light must lie in [0, 1e12]");
    }
}

struct Directions {
  std::vector<elementary::SinCos> column, row;
  std::vector<double> solid_angle;  ///< of a row's pixels

  explicit Directions(ImageView<const Vec3> picture)
      : column(static_cast<std::size_t>(picture.width)),
        row(static_cast<std::size_t>(picture.height)),
        solid_angle(row.size()) {
    const double step = kPi / picture.height;
    for (std::size_t x = 0; x < column.size(); ++x)
      column[x] = elementary::sin_cos((static_cast<double>(x) + 0.5) * step - kPi);
    for (std::size_t y = 0; y < row.size(); ++y) {
      const auto top = static_cast<double>(y);
      row[y] = elementary::sin_cos((top + 0.5) * step);
      solid_angle[y] = step * (elementary::cos(top * step) - elementary::cos((top + 1) * step));
    }
  }
  [[nodiscard]] Vec3d at(std::size_t x, std::size_t y) const {
    return {row[y].sin * column[x].sin, row[y].cos, -row[y].sin * column[x].cos};
  }
};

/// Σ L dω, Σ L w dω and Σ L (w wᵀ − 1/3) dω.
struct Moments {
  double sum[3] = {};
  double first[3][3] = {};
  double second[3][6] = {};

  void add(const Vec3& light, double weight, const Vec3d& w) {
    constexpr double kThird = 1.0 / 3;
    const double quadratic[6] = {w.x * w.x - kThird, w.y * w.y - kThird, w.z * w.z - kThird,
                                 w.x * w.y,          w.y * w.z,          w.z * w.x};
    const double of[3] = {static_cast<double>(light.x) * weight,
                          static_cast<double>(light.y) * weight,
                          static_cast<double>(light.z) * weight};
    for (int c = 0; c < 3; ++c) {
      sum[c] += of[c];
      first[c][0] += of[c] * w.x;
      first[c][1] += of[c] * w.y;
      first[c][2] += of[c] * w.z;
      for (int k = 0; k < 6; ++k) second[c][k] += of[c] * quadratic[k];
    }
  }
  void add(const Moments& other) {
    for (int c = 0; c < 3; ++c) {
      sum[c] += other.sum[c];
      for (int k = 0; k < 3; ++k) first[c][k] += other.first[c][k];
      for (int k = 0; k < 6; ++k) second[c][k] += other.second[c][k];
    }
  }
};

Gathered gathered(parallel::Threads& exec, ImageView<const Vec3> picture,
                  const Directions& directions) {
  std::vector<Moments> rows(directions.row.size());
  parallel::for_each_index(exec, rows.size(), [&](std::size_t y) {
    const Vec3* const pixels = picture.row(static_cast<int>(y));
    for (std::size_t x = 0; x < directions.column.size(); ++x)
      rows[y].add(pixels[x], directions.solid_angle[y], directions.at(x, y));
  });
  Moments all;
  for (const Moments& row : rows) all.add(row);
  Gathered g;
  g.mean = {all.sum[0] / (4 * kPi), all.sum[1] / (4 * kPi), all.sum[2] / (4 * kPi)};
  for (int c = 0; c < 3; ++c) {
    g.rise[c] = Vec3d{all.first[c][0], all.first[c][1], all.first[c][2]} * (1 / (2 * kPi));
    for (int k = 0; k < 6; ++k) {
      const double twice = k < 3 ? 1 : 2;  // xy stands for yx, too
      g.bend[c][k] = all.second[c][k] * twice * (15 / (32 * kPi));
    }
  }
  return g;
}

/// The picture's light in a direction, linear between pixels.
Vec3 look_up(ImageView<const Vec3> picture, const Vec3d& d) {
  const double across = elementary::atan2(d.x, -d.z), down = elementary::acos(d.y);
  const double step = kPi / picture.height;
  const double x = (across + kPi) / step - 0.5, y = down / step - 0.5;
  const double left = std::floor(x), top = std::floor(y);
  const auto fx = static_cast<float>(x - left), fy = static_cast<float>(y - top);
  const auto column = [&](int i) { return (i + picture.width) % picture.width; };
  const auto row = [&](int j) { return std::clamp(j, 0, picture.height - 1); };
  const int x0 = column(static_cast<int>(left)), x1 = column(static_cast<int>(left) + 1);
  const int y0 = row(static_cast<int>(top)), y1 = row(static_cast<int>(top) + 1);
  return (picture(x0, y0) * (1 - fx) + picture(x1, y0) * fx) * (1 - fy) +
         (picture(x0, y1) * (1 - fx) + picture(x1, y1) * fx) * fy;
}

/// The unit direction at a place of the map: OctahedralPlace's inverse.
Vec3d direction_at(double u, double v) {
  double a = 2 * u - 1, b = 2 * v - 1;
  const double y = 1 - std::abs(a) - std::abs(b);
  if (y < 0) {
    const double folded_a = (1 - std::abs(b)) * (a < 0 ? -1 : 1);
    const double folded_b = (1 - std::abs(a)) * (b < 0 ? -1 : 1);
    a = folded_a;
    b = folded_b;
  }
  const Vec3d d{a, y, b};
  return d * (1 / length(d));
}

class Texels {
 public:
  explicit Texels(int size)
      : size_(size),
        texels_(static_cast<std::size_t>(size + 2) * static_cast<std::size_t>(size + 2)) {}
  /// The texel of column x and row y, both from −1 to size.
  Vec4& operator()(int x, int y) {
    return texels_[static_cast<std::size_t>(y + 1) * static_cast<std::size_t>(size_ + 2) +
                   static_cast<std::size_t>(x + 1)];
  }
  /// Fills the border: beyond an edge the map continues at that edge's other end.
  void close() {
    const int last = size_ - 1;
    for (int i = 0; i < size_; ++i) {
      (*this)(i, -1) = (*this)(last - i, 0);
      (*this)(i, size_) = (*this)(last - i, last);
      (*this)(-1, i) = (*this)(0, last - i);
      (*this)(size_, i) = (*this)(last, last - i);
    }
    (*this)(-1, -1) = (*this)(last, last);
    (*this)(size_, size_) = (*this)(0, 0);
    (*this)(-1, size_) = (*this)(last, 0);
    (*this)(size_, -1) = (*this)(0, last);
  }
  [[nodiscard]] std::vector<Vec4> take() { return std::move(texels_); }

 private:
  int size_;
  std::vector<Vec4> texels_;
};

std::vector<Vec4> mirrored(parallel::Threads& exec, ImageView<const Vec3> picture, int size) {
  Texels level(size);
  // Enough look-ups per texel to catch the smallest lamp in the picture.
  const int looks = (picture.height + size - 1) / size;
  const double step = 1.0 / (static_cast<double>(size) * looks);
  const float share = 1 / static_cast<float>(looks * looks);
  parallel::for_each_index(exec, static_cast<std::size_t>(size), [&](std::size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < size; ++x) {
      Vec3 sum;
      for (int j = 0; j < looks; ++j)
        for (int i = 0; i < looks; ++i)
          sum = sum + look_up(picture, direction_at((x * looks + i + 0.5) * step,
                                                    (y * looks + j + 0.5) * step));
      sum = sum * share;
      level(x, y) = {sum.x, sum.y, sum.z, 0};
    }
  });
  level.close();
  return level.take();
}

/// A patch of the picture, and its light times its solid angle.
struct Patch {
  Vec3 direction;
  Vec3 light;
  float solid_angle;
};

std::vector<Patch> patches_of(ImageView<const Vec3> picture, const Directions& directions) {
  const int rows = std::min(picture.height, kSourceRows);
  const auto columns = static_cast<std::size_t>(2 * rows);
  struct Sum {
    Vec3d direction, light;
    double solid_angle = 0;
  };
  std::vector<Sum> sums(columns * static_cast<std::size_t>(rows));
  const auto height = directions.row.size(), width = directions.column.size();
  for (std::size_t y = 0; y < height; ++y) {
    Sum* const row = &sums[y * static_cast<std::size_t>(rows) / height * columns];
    const double w = directions.solid_angle[y];
    for (std::size_t x = 0; x < width; ++x) {
      Sum& sum = row[x * columns / width];
      const Vec3 c = picture(static_cast<int>(x), static_cast<int>(y));
      sum.direction = sum.direction + directions.at(x, y) * w;
      sum.light = sum.light + Vec3d{c.x, c.y, c.z} * w;
      sum.solid_angle += w;
    }
  }
  std::vector<Patch> patches;
  patches.reserve(sums.size());
  for (const Sum& s : sums)
    patches.push_back({Vec3(s.direction * (1 / length(s.direction))), Vec3(s.light),
                       static_cast<float>(s.solid_angle)});
  return patches;
}

/// The light that a surface of this roughness mirrors, by its normal, seen from there: the
/// picture's light times n·l, weighted by the share of facets that reflect it.
std::vector<Vec4> blurred(parallel::Threads& exec, const std::vector<Patch>& patches, int size,
                          double roughness) {
  Texels level(size);
  const auto alpha = static_cast<float>(roughness * roughness);
  const float narrow = (alpha * alpha - 1) * 0.5F;
  parallel::for_each_index(exec, static_cast<std::size_t>(size), [&](std::size_t row) {
    constexpr int kMost = 128;
    float dx[kMost], dy[kMost], dz[kMost], r[kMost] = {}, g[kMost] = {}, b[kMost] = {},
                                           weight[kMost] = {};
    for (int x = 0; x < size; ++x) {
      const Vec3 d(direction_at((x + 0.5) / size, (static_cast<double>(row) + 0.5) / size));
      dx[x] = d.x;
      dy[x] = d.y;
      dz[x] = d.z;
    }
    for (const Patch& patch : patches) {
      const Vec3 l = patch.direction;
      for (int x = 0; x < size; ++x) {
        const float n_l = dx[x] * l.x + dy[x] * l.y + dz[x] * l.z;
        // (n·h)² = (1 + n·l) / 2 where n is v.
        const float lobe = (1 + n_l) * narrow + 1;
        const float share = (n_l > 0 ? n_l : 0.0F) / (lobe * lobe);
        r[x] += share * patch.light.x;
        g[x] += share * patch.light.y;
        b[x] += share * patch.light.z;
        weight[x] += share * patch.solid_angle;
      }
    }
    for (int x = 0; x < size; ++x) {
      const float scale = 1 / weight[x];
      level(x, static_cast<int>(row)) = {r[x] * scale, g[x] * scale, b[x] * scale, 0};
    }
  });
  level.close();
  return level.take();
}

}  // namespace

Environment::Environment(ImageView<const Vec3> picture, int threads) {
  const FloatScope floats;
  check_picture(picture);
  parallel::Threads exec(threads);
  const Directions directions(picture);
  auto data = std::make_unique<Data>();
  data->gathered = gathered(exec, picture, directions);
  const std::vector<Patch> patches = patches_of(picture, directions);
  for (int k = 0; k < EnvironmentMap::kLevels; ++k) {
    const int size = k == 0 ? std::min(picture.height, kSharpest) : kSizes[k];
    const double roughness = static_cast<double>(k) / (EnvironmentMap::kLevels - 1);
    data->texels[k] =
        k == 0 ? mirrored(exec, picture, size) : blurred(exec, patches, size, roughness);
    data->map.levels[k] = {data->texels[k].data(), size};
  }
  data_ = std::move(data);
}

Vec3 Environment::mean() const {
  const FloatScope floats;
  return Vec3(data_->gathered.mean);
}

}  // namespace rastrum
