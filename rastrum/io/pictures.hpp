// SPDX-License-Identifier: BSD-3-Clause
// A scene's pictures, decoded in parallel: they take most of the time to read such a file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <rastrum/error.hpp>
#include <rastrum/image.hpp>
#include <rastrum/io/reading.hpp>
#include <rastrum/scene.hpp>

namespace rastrum::io {

class Pictures {
 public:
  /// `budget` counts the copies that take() makes.
  explicit Pictures(Budget& budget) : budget_(budget) {}
  /// decode_all calls `decode`, whose captures must live until then, on any thread. Returns the
  /// picture's number.
  std::size_t add(std::function<Image<Rgba8>()> decode);
  /// One more use will take it.
  void use_again(std::size_t picture) { ++all_[picture].uses; }
  /// Decodes in parallel. take() throws the errors.
  void decode_all();
  /// Call it once per use; the last gets no copy. Requires decode_all. Throws the picture's error.
  [[nodiscard]] Image<Rgba8> take(std::size_t picture);

 private:
  struct Picture {
    std::function<Image<Rgba8>()> decode;
    Image<Rgba8> image;
    std::exception_ptr error;
    int uses = 1;  ///< still to come
  };
  Budget& budget_;
  std::vector<Picture> all_;
};

/// Whether an error is not the picture's fault.
[[nodiscard]] inline bool is_of_the_call(const Error& e) {
  return e.code() == Errc::out_of_memory || e.code() == Errc::stopped;
}

/// Adds the texture of picture `file` that make() gives; returns its number. An unreadable one is
/// none, and a warning of the document `name`: it costs the texture, not the scene.
template <class Make>
std::int32_t add_texture(std::vector<Texture>& textures, std::vector<std::string>& warnings,
                         const std::string& name, const std::filesystem::path& file,
                         const Make& make) {
  try {
    Texture texture = make();
    texture.name = file.filename().string();
    textures.push_back(std::move(texture));
    return static_cast<std::int32_t>(textures.size()) - 1;
  } catch (const Error& e) {
    if (is_of_the_call(e)) throw;
    warnings.push_back(name + ": drawn without a texture: " + e.what());
    return kNoTexture;
  }
}

}  // namespace rastrum::io
