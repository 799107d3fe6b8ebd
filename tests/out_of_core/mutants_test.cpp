// SPDX-License-Identifier: BSD-3-Clause
// Small random changes of small files. Out of core gives the reader's error or picture, or refuses,
// with a reason, a file that the reader accepts.
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/error.hpp>
#include <rastrum/io.hpp>

#include "tests/out_of_core/large_files.hpp"

namespace rastrum::test::mutants_test {
namespace {

struct Outcome {
  std::string said;  ///< empty: it was drawn
  Errc code{};
  std::vector<std::int64_t> ids;

  /// Whether the file is refused as unsupported out of core.
  [[nodiscard]] bool is_kind() const {
    return code == Errc::unsupported && said.find(": out of core: ") != std::string::npos;
  }
};

template <class Draw>
Outcome outcome_of(const Draw& draw) {
  Outcome outcome;
  Image<std::int64_t> ids(24, 24);
  FrameOptions frame{.width = 24, .height = 24};
  Targets targets{.ids = ids};
  try {
    draw(Camera{.eye = {0, 0, 3}}, frame, targets);
    outcome.ids.assign(ids.pixels().begin(), ids.pixels().end());
  } catch (const Error& e) {
    outcome.said = e.what();
    outcome.code = e.code();
  }
  return outcome;
}

Outcome read(const std::filesystem::path& file) {
  return outcome_of([&](const Camera& camera, const FrameOptions& frame, const Targets& targets) {
    const Scene scene = io::read_scene(file);
    Renderer({.threads = 1}).render(SceneBinding(scene).view(), camera, frame, targets);
  });
}

Outcome mapped(const std::filesystem::path& file) {
  return outcome_of([&](const Camera& camera, const FrameOptions& frame, const Targets& targets) {
    OutOfCoreOptions options;
    options.renderer.threads = 1;
    (void)OutOfCoreFile(file).render(camera, frame, targets, options);
  });
}

/// One to three changes, many in the header.
std::string mutant_of(std::string bytes, Random& random) {
  const auto place = [&] {
    const auto last = static_cast<int>(bytes.size()) - 1;
    return static_cast<std::size_t>(
        random.integer(0, random.integer(0, 1) == 0 ? last : std::min(last, 400)));
  };
  for (int n = random.integer(1, 3); n > 0 && !bytes.empty(); --n) {
    const std::size_t at = place();  // before the call, since the order of arguments is unspecified
    switch (random.integer(0, 6)) {
      case 0:
        bytes[at] = static_cast<char>(random.integer(0, 255));
        break;
      case 1:
        bytes[at] ^= static_cast<char>(1U << static_cast<unsigned>(random.integer(0, 7)));
        break;
      case 2:
        bytes.erase(at, static_cast<std::size_t>(random.integer(1, 9)));
        break;
      case 3:
        bytes.insert(at, bytes.substr(place(), 8));
        break;
      case 4:
        bytes.resize(at);
        break;
      case 5: {  // a digit, as in counts
        const std::size_t digit = bytes.find_first_of("0123456789", at);
        if (digit != std::string::npos)
          bytes[digit] = static_cast<char>('0' + random.integer(0, 9));
        break;
      }
      default:
        bytes.replace(at, 4, raw(std::uint32_t{0xFFFFFFFF}));
    }
  }
  return bytes;
}

TEST(Mutants, OutOfCoreSaysWhatTheReaderSays) {
  const TempFolder folder;
  const Mesh mesh = shapes::sphere(3, 5);
  const std::string material = R"({"pbrMetallicRoughness":{"baseColorFactor":[1,0,0,1]}})";
  const std::pair<std::string, std::string> kinds[] = {
      {"ply", ply_of(mesh)},
      {"ply", ply_of(mesh, {.normals = true, .colors = true, .alpha = 128})},
      {"ply", ply_of(mesh, {.wide_at = Vec3d{5.2e6, 0, 5.2e6}})},
      {"stl", stl_of(mesh)},
      {"npy", npy_of(mesh, false, false)},
      {"npy", npy_of(mesh, true, true)},
      {"glb", glb_of(mesh, false, material)},
      {"glb", many_glb_of({mesh, mesh, mesh, mesh}, "")},
  };
  constexpr int kOfEach = 300;
  int accepted = 0, refused = 0;
  int of_a_kind = 0;
  for (std::size_t k = 0; k < std::size(kinds); ++k) {
    const auto& [format, good] = kinds[k];
    ASSERT_EQ(mapped(folder.write("good." + format, good)).said, "");
    Random random(100 + k);
    for (int i = 0; i < kOfEach; ++i) {
      const auto file = folder.write("mutant." + format, mutant_of(good, random));
      const Outcome in_memory = read(file), out_of_core = mapped(file);
      const std::string what = format + " " + std::to_string(k) + ", " + std::to_string(i);
      if (in_memory.said.empty() && out_of_core.is_kind()) {
        ++of_a_kind;
        continue;
      }
      ++(in_memory.said.empty() ? accepted : refused);
      EXPECT_EQ(out_of_core.said, in_memory.said) << what;
      EXPECT_EQ(out_of_core.code, in_memory.code) << what;
      EXPECT_TRUE(out_of_core.ids == in_memory.ids) << what;
    }
  }
  EXPECT_GT(accepted, 200);
  EXPECT_GT(refused, 500);
  EXPECT_LT(of_a_kind, 100);
}

}  // namespace
}  // namespace rastrum::test::mutants_test
