// SPDX-License-Identifier: BSD-3-Clause
// The pictures of a scene's textures, which are most of what such a file takes to read: decoded
// side by side.
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
  /// Copies that take() makes are taken from `budget`.
  explicit Pictures(Budget& budget) : budget_(budget) {}
  /// `decode` is called by decode_all, on any thread; what it refers to must live until then.
  /// Returns the picture's number.
  std::size_t add(std::function<Image<Rgba8>()> decode);
  /// One more will take it.
  void use_again(std::size_t picture) { ++all_[picture].uses; }
  /// All that were added, by what threads there are. Throws nothing of theirs.
  void decode_all();
  /// For each use once; the last has no copy. Requires decode_all. Throws what decoding the picture
  /// threw, at each call.
  [[nodiscard]] Image<Rgba8> take(std::size_t picture);

 private:
  struct Picture {
    std::function<Image<Rgba8>()> decode;
    Image<Rgba8> image;
    std::exception_ptr error;
    int uses = 1;  ///< that are still to come
  };
  Budget& budget_;
  std::vector<Picture> all_;
};

/// Whether an error is no fault of the picture that was read.
[[nodiscard]] inline bool is_of_the_call(const Error& e) {
  return e.code() == Errc::out_of_memory || e.code() == Errc::stopped;
}

/// Adds the texture that make() gives, of a picture's `file`; returns its number. One that cannot
/// be read is none, and a warning of the document `name`: it costs the texture, not the scene.
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
