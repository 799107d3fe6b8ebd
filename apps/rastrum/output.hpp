// Files that are written: checked before any work is done, format by extension.
#pragma once

#include <filesystem>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>

#include <rastrum/core/image.hpp>

namespace rastrum::cli {

enum class Format { png, exr, npy, ply, json, mp4 };

/// A file that an option asks for; `file` is empty where the option was not given.
struct Output {
  std::string option;
  std::filesystem::path file;
  Format format = Format::png;

  explicit operator bool() const { return !file.empty(); }
};

/// The format by extension, any case. Throws UsageError unless it is one of `formats`.
[[nodiscard]] Output parse_output(std::string_view option, const std::string& file,
                                  std::initializer_list<Format> formats);

/// Throws UsageError where two options name one file, Error{io} where a directory is missing or
/// not writable: an hour of work should not end with that. Outputs not asked for are ignored.
void check_outputs(std::span<const Output* const> outputs);

void write_color(const Output& output, ImageView<const Rgba8> color8, ImageView<const Vec4> color);
void write_depth(const Output& output, ImageView<const float> depth);

}  // namespace rastrum::cli
