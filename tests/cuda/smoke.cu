// Instantiates for the device what the host shares with it: the arithmetic of core/, and the words.
// Compiling is the test; tests/cuda/CMakeLists.txt.
#include <cstdint>

#include <rastrum/core/mat.hpp>
#include <rastrum/core/vec.hpp>
#include <rastrum/parallel/cuda/exec.cuh>

namespace rastrum {

struct ProjectVertex {
  Mat4 to_clip;
  RASTRUM_HD Vec4 operator()(Vec3 p) const { return transform_point(to_clip, p); }
};

struct TowardsEye {
  const Vec3* normals;
  Vec3 eye;
  std::uint32_t* flags;
  RASTRUM_HD void operator()(std::size_t i) const {
    const Vec3 n = normalize(normals[i]);
    flags[i] = is_finite(n) && dot(n, eye) > 0 ? 1 : 0;
  }
};

struct Plus {
  RASTRUM_HD std::uint32_t operator()(std::uint32_t a, std::uint32_t b) const { return a + b; }
};

/// Every word once, in the shape of a filter: flag, scan, scatter, sort. Device pointers of n
/// elements each.
std::uint32_t instantiate_words(parallel::Cuda& exec, std::size_t n, const Mat4& to_clip, Vec3 eye,
                                const Vec3* positions, const Vec3* normals, Vec4* clip,
                                Vec4* gathered, std::uint32_t* flags, std::uint32_t* places,
                                std::uint32_t* order) {
  parallel::transform(exec, positions, n, clip, ProjectVertex{to_clip});
  parallel::for_each_index(exec, n, TowardsEye{normals, eye, flags});
  parallel::exclusive_scan(exec, flags, n, places, 0U, Plus{});
  parallel::scatter(exec, flags, n, places, order);
  parallel::inclusive_scan(exec, flags, n, places, Plus{});
  parallel::sort_by_key(exec, places, n, order);
  parallel::gather(exec, order, n, clip, gathered);
  return parallel::reduce(exec, flags, n, 0U, Plus{});
}

}  // namespace rastrum
