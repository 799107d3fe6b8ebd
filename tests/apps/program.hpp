// SPDX-License-Identifier: BSD-3-Clause
// Runs the built program in a directory of the test's own, and reads back what it wrote.
#pragma once

#include <sys/types.h>

#include <cstring>
#include <filesystem>
#include <ostream>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <rastrum/image.hpp>
#include <rastrum/render.hpp>

#include "tests/io/files.hpp"
#include "tests/support/painter.hpp"
#include "tests/support/refused.hpp"

namespace rastrum::test {

/// Words of a command line: a list's items as they are, a text's words between blanks.
struct Args : std::vector<std::string> {
  Args() = default;
  Args(std::initializer_list<std::string> words) : vector(words) {}
  Args(const std::string& line) {
    std::istringstream in(line);
    for (std::string word; in >> word;) push_back(word);
  }
  Args(const char* line) : Args(std::string(line)) {}
};
[[nodiscard]] inline Args operator+(Args a, const Args& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}
inline std::ostream& operator<<(std::ostream& out, const Args& args) {
  for (const std::string& word : args) out << " " << word;
  return out;
}

struct Outcome {
  int status = -1;  ///< 128 + signal if it was killed
  std::string out, err;
};

/// Limits of the system for the program.
struct Limits {
  long file_bytes = -1;  ///< writes beyond it fail, as on a full disk
  bool stdout_full = false;
};

class Program : public testing::Test {
 protected:
  /// Runs `rastrum args…` in the test's directory.
  [[nodiscard]] Outcome run(const Args& args, Limits limits = {}) const;
  /// Runs a script of sh in the test's directory. $RASTRUM is the program.
  [[nodiscard]] Outcome shell(const std::string& script) const;
  /// Starts `rastrum args…`; wait() returns its outcome.
  [[nodiscard]] pid_t start(const Args& args) const;
  [[nodiscard]] Outcome wait(pid_t program) const;
  /// Runs it and expects success. Returns its stderr.
  std::string must(const Args& args) const;
  /// Runs it and expects `status` and `part` in its stderr, which it returns.
  std::string refused(const Args& args, const std::string& part, int status = 2) const;
  /// Returns the picture of `args… -o FILE`.
  [[nodiscard]] Image<Rgba8> drawn(const Args& args) const;
  /// Compares a film of args… along a path of `pictures` pictures with the single pictures: on
  /// average, a pixel's channels differ by less than `most` together. Skipped without ffmpeg.
  void expect_film(const Args& args, int pictures, const std::string& width_height,
                   double most) const;
  /// Runs the command line in the file beside a screenshot, which writes a picture.
  void run_line(const std::string& line) const;

  [[nodiscard]] std::filesystem::path path(const std::string& name) const {
    return folder_.path(name);
  }
  /// A path beside the folder, so that the folder has only the program's own files.
  [[nodiscard]] std::filesystem::path beside(const std::string& ending) const {
    return path("").parent_path().string() + ending;
  }
  [[nodiscard]] Args files() const;  ///< names in the directory, sorted
  void write(const std::string& name, const std::string& text) const { folder_.write(name, text); }
  [[nodiscard]] std::string read(const std::string& name) const { return slurp(path(name)); }
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
    /// Whether the array equals the image.
    template <class T>
    [[nodiscard]] bool holds(const Image<T>& image) const {
      const auto pixels = image.pixels();
      return data == std::string(reinterpret_cast<const char*>(pixels.data()), pixels.size_bytes());
    }
  };
  [[nodiscard]] Npy npy(const std::string& name) const;
  /// The channels of an EXR as float32 planes, in the given order.
  [[nodiscard]] std::vector<std::vector<float>> exr(const std::string& name,
                                                    const Args& channels) const;

 private:
  [[nodiscard]] pid_t start(const Args& command, Limits limits) const;
  TempFolder folder_;
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
