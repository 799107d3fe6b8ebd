// Runs the built program in a directory of the test's own, and reads back what it wrote.
#pragma once

#include <sys/types.h>

#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <rastrum/image.hpp>
#include <rastrum/render.hpp>

#include "tests/support/painter.hpp"
#include "tests/support/refused.hpp"

namespace rastrum::test {

using Args = std::vector<std::string>;
[[nodiscard]] inline Args operator+(Args a, const Args& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

struct Outcome {
  int status = -1;  ///< 128 + signal where it did not exit
  std::string out, err;
};

/// Limits that the system sets the program.
struct Limits {
  long file_bytes = -1;  ///< writes beyond it fail, as on a full disk
  bool stdout_full = false;
};

class Program : public testing::Test {
 protected:
  void SetUp() override;
  void TearDown() override;

  /// Runs `rastrum args…` with the test's directory as the current one.
  [[nodiscard]] Outcome run(const Args& args, Limits limits = {}) const;
  /// Runs a script of sh's in that directory, in which $RASTRUM is the program.
  [[nodiscard]] Outcome shell(const std::string& script) const;
  /// Begins `rastrum args…`; wait() gives its outcome, as run() does.
  [[nodiscard]] pid_t start(const Args& args) const;
  [[nodiscard]] Outcome wait(pid_t program) const;
  /// The same, which must succeed; returns what it said on stderr.
  std::string must(const Args& args) const;
  /// The same, which must end with `status` and say `part`.
  void refused(const Args& args, const std::string& part, int status = 2) const;

  [[nodiscard]] std::filesystem::path path(const std::string& name) const { return folder_ / name; }
  [[nodiscard]] Args files() const;  ///< names in the directory, sorted
  void write(const std::string& name, const std::string& text) const;
  [[nodiscard]] std::string read(const std::string& name) const;
  [[nodiscard]] nlohmann::ordered_json json(const std::string& name) const;
  [[nodiscard]] Image<Rgba8> png(const std::string& name) const;

  struct Npy {
    std::string header;
    std::string data;
    template <class T>
    [[nodiscard]] std::vector<T> values() const {
      std::vector<T> v(data.size() / sizeof(T));
      std::memcpy(v.data(), data.data(), v.size() * sizeof(T));
      return v;
    }
  };
  [[nodiscard]] Npy npy(const std::string& name) const;
  /// The channels of an EXR, one plane each in the order named, as float32.
  [[nodiscard]] std::vector<std::vector<float>> exr(const std::string& name,
                                                    const Args& channels) const;

 private:
  [[nodiscard]] pid_t start(const Args& command, Limits limits) const;
  std::filesystem::path folder_;
};

/// The library's picture, for comparison with the program's.
struct Drawn {
  Image<Rgba8> color8;
  Image<Vec4> color;
  Image<float> depth;
  Image<std::int64_t> ids;
  FrameStats stats;
};
[[nodiscard]] Drawn draw(const Scene& scene, const Camera& camera, const RenderOptions& options);

/// One mesh at the origin.
[[nodiscard]] Scene scene_of(Mesh mesh);
/// The default camera.
[[nodiscard]] Camera fit(const Scene& scene, const RenderOptions& options);

inline bool same_pixels(const Image<Rgba8>& a, const Image<Rgba8>& b) {
  return a.width() == b.width() && a.height() == b.height() &&
         std::equal(a.pixels().begin(), a.pixels().end(), b.pixels().begin());
}

}  // namespace rastrum::test
