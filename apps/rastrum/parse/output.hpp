// SPDX-License-Identifier: BSD-3-Clause
// Output files as options name them, with a format by extension; checked before any work.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "arguments.hpp"

namespace rastrum::cli {

enum class Format { png, exr, npy, ply, json, mp4 };

/// `file` is empty if the option was not given.
struct Output {
  std::string option;
  std::filesystem::path file;
  Format format = Format::png;

  explicit operator bool() const { return !file.empty(); }
  [[nodiscard]] bool to_stdout() const { return file == "-"; }
  [[nodiscard]] bool is_film() const { return !file.empty() && format == Format::mp4; }
  [[nodiscard]] std::string name() const;
};

/// The format comes from the extension, in any case, else from `format`; "-" or /dev/stdout is
/// standard output, by default in the first of `formats`. Throws UsageError unless it is one of
/// `formats`, or if name and `format` contradict.
[[nodiscard]] Output parse_output(std::string_view option, const std::string& file,
                                  const std::vector<Format>& formats,
                                  std::optional<Format> format = {});

/// Parses FILE into `output`; `name` has static storage.
Option add_output(Parser& app, const char* name, const std::string& help, Output& output,
                  std::vector<Format> formats);

/// Checks before an hour of work: throws UsageError if two options name one file, or one that is
/// read (files.hpp; links are followed), or if a picture would go to a terminal; Error{io} if a
/// directory or a file is missing or not writable. Ignores outputs not asked for. Removes the
/// temporaries of killed programs from those directories. `hash`: standard output gets digests, and
/// has no room for more.
void check_outputs(std::span<const Output* const> outputs, bool hash = false);

/// Throws UsageError if `output` is a file that has been read by now.
void check_is_not_read(const Output& output);

/// A name with at most one %d, %3d or %04d in it; %% is a percent sign.
class NumberedName {
 public:
  /// Throws UsageError naming `option` for other percent signs.
  NumberedName(std::string_view option, std::string_view pattern);
  [[nodiscard]] bool has_number() const { return has_number_; }
  [[nodiscard]] std::string at(std::size_t number) const;

 private:
  std::string before_, after_;
  bool has_number_ = false, zeros_ = false;
  std::size_t width_ = 0;
};

/// For picture `number`; a film is the same for all. Throws UsageError if `count` pictures share a
/// name.
[[nodiscard]] Output numbered(Output output, std::size_t number, std::size_t count);
/// Checks, before the first picture of a sequence is written, that no output is another or is read.
/// `of_pictures`: one file per picture; `of_run`: one for the run.
void check_numbered(std::span<const Output* const> of_pictures,
                    std::span<const Output* const> of_run, std::size_t count);

/// Options of a whole run, for meshes and terrains.
struct RunOptions {
  std::filesystem::path path;  ///< of the camera; may be empty
  std::optional<double> fps;   ///< pictures per second
  std::optional<int> frames;   ///< times that one picture is drawn
  bool quiet = false, hash = false;
  Output stats;

  [[nodiscard]] double pictures_a_second() const { return fps.value_or(30); }
};
void add_path_options(Parser app, RunOptions& a, const std::string& fps_help);
void add_frames_option(Parser app, RunOptions& a);
void add_hash_option(Parser app, RunOptions& a);

}  // namespace rastrum::cli
