// SPDX-License-Identifier: BSD-3-Clause
// Reads every file of the shared folder of malformed and odd files and compares with the table
// bad_files.txt: errors have the stated code and name the file, scenes have the stated number of
// triangles, and pictures equal their twins. Each file is read in a process of its own with at most
// 1 GiB more of address space, within 2 s. Sanitizers' shadow memory would exceed that limit, so
// under one the test reads in this process and checks only the time.
//
// A line of the table: PATH EXPECTATION, where the expectation is one of
//   refuse CODE         an Error of that code
//   draw N [= PATH]     a scene of N triangles, with the corners of that other file's
//   image WxH [= PATH]  a picture, with the pixels of that other picture (.pgm and .ppm too)
// A comment after '#' gives the source of the expectation. A PATH with wildcards stands for every
// file that no line names and no earlier pattern matches. In "= FOLDER/" the other file has the
// same name.

#include <fnmatch.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#include <algorithm>

#include <array>
#include <exception>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/error.hpp>
#include <rastrum/io.hpp>
#include <rastrum/render.hpp>

#include "tests/io/files.hpp"
#include "tests/support/directories.hpp"
#include "tests/support/painter.hpp"

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define RASTRUM_TEST_SANITIZED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define RASTRUM_TEST_SANITIZED 1
#endif
#endif

namespace rastrum::test::bad_files_test {
namespace {

namespace fs = std::filesystem;

/// Processor time, not wall time, because other programs may keep the processors busy.
#ifdef RASTRUM_TEST_SANITIZED
constexpr double kMostSeconds = 20;
#else
constexpr double kMostSeconds = 2;
#endif

struct Row {
  std::string path, verb, detail, twin;
};

fs::path bad_dir() {
  return shared_dir() / "bad";
}

/// The files to read: no licences, validator's reports, or buffers of glTF files.
bool is_input(const fs::path& file) {
  static const std::set<std::string> kOthers = {".json", ".md", ".c", ".bin", ""};
  return kOthers.count(file.extension().string()) == 0;
}

std::set<std::string> files_there() {
  std::set<std::string> there;
  for (const auto& entry : fs::recursive_directory_iterator(bad_dir()))
    if (entry.is_regular_file() && is_input(entry.path()))
      there.insert(fs::relative(entry.path(), bad_dir()).string());
  return there;
}

/// One row for each file.
std::vector<Row> read_table() {
  std::vector<Row> rows, patterns;
  std::set<std::string> others = files_there();
  std::ifstream in(RASTRUM_BAD_FILES_TABLE);
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line.substr(0, line.find('#')));
    Row r;
    std::string equals;
    if (!(words >> r.path)) continue;
    words >> r.verb >> r.detail >> equals >> r.twin;
    const bool is_pattern = r.path.find_first_of("*?[") != std::string::npos;
    (is_pattern ? patterns : rows).push_back(r);
    others.erase(r.path);
  }
  for (const Row& pattern : patterns)
    for (auto file = others.begin(); file != others.end();) {
      if (::fnmatch(pattern.path.c_str(), file->c_str(), 0) != 0) {
        ++file;
        continue;
      }
      Row r = pattern;
      r.path = *file;
      if (r.twin.ends_with('/')) r.twin += fs::path(r.path).filename().string();
      rows.push_back(r);
      file = others.erase(file);
    }
  return rows;
}

bool is_mesh(const fs::path& file) {
  static const std::set<std::string> kMeshes = {".obj", ".ply", ".stl", ".STL",
                                                ".off", ".glb", ".gltf"};
  return kMeshes.count(file.extension().string()) != 0;
}

std::string name_of(Errc code) {
  switch (code) {
    case Errc::invalid_argument:
      return "invalid_argument";
    case Errc::not_found:
      return "not_found";
    case Errc::io:
      return "io";
    case Errc::bad_format:
      return "bad_format";
    case Errc::unsupported:
      return "unsupported";
    case Errc::out_of_memory:
      return "out_of_memory";
    case Errc::no_device:
      return "no_device";
    case Errc::stopped:
      return "stopped";
  }
  return "?";
}

/// Draws the scene by the reference and by threads: they must agree and lose no triangle.
std::string draw(const Scene& scene) {
  constexpr int kSize = 64;
  const SceneBinding binding(scene);
  const Camera camera = fit_camera(binding.view(), 1.0472F, false);
  Image<std::int64_t> ids[2];
  Image<Rgba8> colors[2];
  FrameStats stats[2];
  for (int i = 0; i < 2; ++i) {
    RenderOptions options({.width = kSize,
                           .height = kSize,
                           .shader = scene.materials.empty() ? Shader::phong : Shader::material},
                          {.device = i == 0 ? Device::serial : Device::threads, .threads = 2});
    ids[i] = Image<std::int64_t>(kSize, kSize);
    colors[i] = Image<Rgba8>(kSize, kSize);
    Targets targets{.color8 = colors[i].view(), .ids = ids[i].view()};
    stats[i] = Painter(options).render(binding.view(), camera, targets);
  }
  if (!std::ranges::equal(ids[0].pixels(), ids[1].pixels())) return "two pictures of it";
  if (stats[0].triangles.input != scene.primitive_count()) return "triangles lost";
  for (const FrameStats& s : stats)
    if (s.triangles.input != s.triangles.dropped + s.triangles.culled + s.triangles.drawn)
      return "triangles that do not add up";
  return {};
}

/// Checks a scene and draws it. Returns the first error.
std::string examine(const Scene& scene) {
  for (const Instance& i : scene.instances)
    if (!i.geometry && i.mesh >= scene.meshes.size()) return "an instance of no mesh";
  for (const Mesh& m : scene.meshes) {
    const auto sound = [&](const auto& attribute) {
      if (attribute.indices.empty())
        return attribute.values.empty() || attribute.values.size() == m.positions.size();
      if (attribute.indices.size() != m.indices.size()) return false;
      for (const std::uint32_t i : attribute.indices)
        if (i >= attribute.values.size()) return false;
      return true;
    };
    for (const std::uint32_t i : m.indices)
      if (i >= m.positions.size()) return "an index beyond the positions";
    if (!sound(m.normals) || !sound(m.texcoords) || !sound(m.colors)) return "a bad attribute";
    if (!m.face_materials.empty() && m.face_materials.size() != m.triangle_count())
      return "face_materials of the wrong length";
  }
  return draw(scene);
}

std::vector<Vec3> corners(const Scene& scene) {
  std::vector<Vec3> r;
  for (const Mesh& m : scene.meshes)
    for (const std::uint32_t i : m.indices) r.push_back(m.positions[i]);
  return r;
}

std::string compare_corners(const Scene& a, const Scene& b) {
  const auto x = corners(a), y = corners(b);
  if (x.size() != y.size()) return "its twin has another number of corners";
  for (std::size_t i = 0; i < x.size(); ++i)
    // The ASCII twins have 6 decimals.
    if (!(length(x[i] - y[i]) <= 2e-6F)) return "corner " + std::to_string(i) + " differs";
  return {};
}

/// Binary PGM and PPM, 8 or 16 bit: the twins that are not PNGs.
Image<Rgba8> read_pnm(const fs::path& file) {
  const std::string bytes = slurp(file);
  std::size_t at = 2;
  const auto number = [&] {
    while (std::isspace(static_cast<unsigned char>(bytes.at(at))) || bytes[at] == '#')
      at = bytes[at] == '#' ? bytes.find('\n', at) : at + 1;
    int n = 0;
    while (std::isdigit(static_cast<unsigned char>(bytes.at(at)))) n = n * 10 + (bytes[at++] - '0');
    return n;
  };
  const int channels = bytes.at(1) == '6' ? 3 : 1;
  const int width = number(), height = number(), max = number();
  ++at;
  Image<Rgba8> image(width, height);
  for (Rgba8& p : image.pixels()) {
    std::array<std::uint8_t, 3> c{};
    for (int k = 0; k < channels; ++k) {
      int v = static_cast<unsigned char>(bytes.at(at++));
      if (max > 255) v = v * 256 + static_cast<unsigned char>(bytes.at(at++));
      c[static_cast<std::size_t>(k)] = static_cast<std::uint8_t>((v * 255 + max / 2) / max);
    }
    p = channels == 3 ? Rgba8{c[0], c[1], c[2], 255} : Rgba8{c[0], c[0], c[0], 255};
  }
  return image;
}

std::string compare_pixels(const Image<Rgba8>& a, const fs::path& twin) {
  const Image<Rgba8> b = twin.extension() == ".png" ? io::read_image(twin) : read_pnm(twin);
  if (a.width() != b.width() || a.height() != b.height()) return "its twin has another size";
  for (std::size_t i = 0; i < a.pixels().size(); ++i)
    // The colour of a fully transparent pixel does not count.
    if (!(a.pixels()[i] == b.pixels()[i]) && (a.pixels()[i].a != 0 || b.pixels()[i].a != 0))
      return "pixel " + std::to_string(i) + " differs from its twin";
  return {};
}

/// Reads the file. Returns the outcome in the table's words, or an error.
std::string outcome(const Row& row) {
  const fs::path file = bad_dir() / row.path;
  try {
    std::string fault;
    std::string result;
    if (is_mesh(file)) {
      const Scene scene = io::read_scene(file);
      result = "draw " + std::to_string(scene.triangle_count());
      fault = examine(scene);
      if (fault.empty() && !row.twin.empty())
        fault = compare_corners(scene, io::read_scene(bad_dir() / row.twin));
    } else {
      const Image<Rgba8> image = io::read_image(file);
      result = "image " + std::to_string(image.width()) + "x" + std::to_string(image.height());
      if (!row.twin.empty()) fault = compare_pixels(image, bad_dir() / row.twin);
    }
    return fault.empty() ? result : result + ", but " + fault;
  } catch (const Error& e) {
    const std::string what = e.what();
    const bool names = what.find(file.filename().string()) != std::string::npos;
    return "refuse " + name_of(e.code()) +
           (names ? "" : ", but the error does not name the file: " + what);
  } catch (const std::exception& e) {
    return std::string("an exception that is no Error: ") + e.what();
  }
}

#ifdef RASTRUM_TEST_SANITIZED
std::string outcome_within_limits(const Row& row) {
  return outcome(row);
}
#else
/// Address space in use now, in bytes.
std::size_t address_space() {
  std::ifstream statm("/proc/self/statm");
  std::size_t pages = 0;
  statm >> pages;
  return pages * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
}

/// In a child process, so that a crash or hang is an outcome too.
std::string outcome_within_limits(const Row& row) {
  int ends[2];
  if (::pipe(ends) != 0) return "no pipe";
  const pid_t child = ::fork();
  if (child == 0) {
    const std::size_t most = address_space() + (std::size_t{1} << 30);
    const rlimit limit{most, most};
    ::setrlimit(RLIMIT_AS, &limit);
    ::alarm(20);
    const std::string text = outcome(row);
    const auto written = ::write(ends[1], text.data(), text.size());
    ::_exit(written == static_cast<ssize_t>(text.size()) ? 0 : 1);
  }
  ::close(ends[1]);
  std::string text;
  char buffer[4096];
  for (ssize_t n = 0; (n = ::read(ends[0], buffer, sizeof buffer)) > 0;)
    text.append(buffer, static_cast<std::size_t>(n));
  ::close(ends[0]);
  int status = 0;
  ::waitpid(child, &status, 0);
  if (WIFSIGNALED(status)) return "killed by signal " + std::to_string(WTERMSIG(status));
  return text;
}
#endif

/// Processor time of this process and its finished children.
double processor_seconds() {
  double seconds = 0;
  for (const auto who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
    rusage used{};
    ::getrusage(who, &used);
    for (const timeval& t : {used.ru_utime, used.ru_stime})
      seconds += static_cast<double>(t.tv_sec) + static_cast<double>(t.tv_usec) * 1e-6;
  }
  return seconds;
}

class BadFilesTable : public testing::Test {
 protected:
  void SetUp() override {
    if (!fs::exists(bad_dir())) GTEST_SKIP() << bad_dir() << " is not there";
  }
};

class BadFiles : public BadFilesTable, public testing::WithParamInterface<const char*> {};

TEST_P(BadFiles, EndAsTheTableSays) {
  std::size_t rows = 0, drawn = 0;
  std::ofstream found;
  // To make a new table: RASTRUM_BAD_FILES_FOUND=FILE collects the outcomes.
  if (const char* to = std::getenv("RASTRUM_BAD_FILES_FOUND")) found.open(to, std::ios::app);
  for (const Row& row : read_table()) {
    if (row.path.rfind(GetParam(), 0) != 0) continue;
    SCOPED_TRACE(row.path);
    const double start = processor_seconds();
    const std::string got = outcome_within_limits(row);
    EXPECT_EQ(got, row.verb + " " + row.detail);
    EXPECT_LT(processor_seconds() - start, kMostSeconds);
    found << row.path << ' ' << got << '\n';
    ++rows;
    drawn += row.verb != "refuse" ? 1U : 0U;
  }
  EXPECT_GT(rows, 0U);
  EXPECT_GT(drawn, 0U) << "refusing everything is no way out";
}

INSTANTIATE_TEST_SUITE_P(Shared, BadFiles,
                         testing::Values("gltf-validator/", "numpy-stl/", "stb/", "trimesh/"),
                         [](const testing::TestParamInfo<const char*>& folder) {
                           std::string name = folder.param;
                           std::erase_if(name, [](char c) { return c == '-' || c == '/'; });
                           return name;
                         });

TEST_F(BadFilesTable, NamesEveryFile) {
  std::set<std::string> listed;
  for (const Row& row : read_table())
    EXPECT_TRUE(listed.insert(row.path).second) << row.path << " is listed twice";
  EXPECT_EQ(listed, files_there());
  EXPECT_EQ(listed.size(), 706U);
}

TEST_F(BadFilesTable, DrawsWhatTheValidatorFindsSound) {
  std::size_t sound = 0;
  for (const Row& row : read_table()) {
    const fs::path report = bad_dir() / (row.path + ".report.json");
    if (!fs::exists(report)) continue;
    const std::string text = slurp(report);
    const auto at = text.find("\"numErrors\":");
    ASSERT_NE(at, std::string::npos) << report;
    if (std::stoi(text.substr(at + 12)) != 0) continue;
    ++sound;
    EXPECT_EQ(row.verb, "draw") << row.path;
  }
  EXPECT_EQ(sound, 129U);
}

TEST_F(BadFilesTable, RefusesWhatPngSuiteCallsCorrupt) {
  std::size_t corrupt = 0;
  for (const Row& row : read_table()) {
    if (row.path.find("pngsuite/") == std::string::npos) continue;
    const bool is_corrupt = row.path.find("/corrupt/") != std::string::npos;
    const bool is_iphone = row.path.find("/iphone/") != std::string::npos;
    EXPECT_EQ(row.verb == "refuse", is_corrupt || is_iphone) << row.path;
    if (row.path.find("/primary/") != std::string::npos) {
      EXPECT_NE(row.twin.find("/primary_check/"), std::string::npos) << row.path;
    }
    corrupt += is_corrupt ? 1U : 0U;
  }
  EXPECT_EQ(corrupt, 14U);
}

}  // namespace
}  // namespace rastrum::test::bad_files_test
