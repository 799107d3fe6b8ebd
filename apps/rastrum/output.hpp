// Files that are written: checked before any work is done, format by extension, all or none.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>

#include <rastrum/digest.hpp>
#include <rastrum/image.hpp>
#include <rastrum/io.hpp>
#include <rastrum/vec.hpp>

namespace rastrum::cli {

enum class Format { png, exr, npy, ply, json, mp4 };

/// A file that an option asks for; `file` is empty where the option was not given.
struct Output {
  std::string option;
  std::filesystem::path file;
  Format format = Format::png;

  explicit operator bool() const { return !file.empty(); }
  [[nodiscard]] bool to_stdout() const { return file == "-"; }
  /// For messages.
  [[nodiscard]] std::string name() const;
};

/// The format by extension, any case. Where the name does not say it is `format`, if given; "-" or
/// /dev/stdout is standard output, otherwise in the first of `formats`.
/// Throws UsageError unless it is one of `formats`, or where name and `format` contradict.
[[nodiscard]] Output parse_output(std::string_view option, const std::string& file,
                                  std::initializer_list<Format> formats,
                                  std::optional<Format> format = {});

/// Throws UsageError where two options name one file, or one that is read (files.hpp; links are
/// followed), or a picture would go to a terminal, Error{io} where a directory or a file is missing
/// or not writable, before an hour of work ends with that. Outputs not asked for are ignored.
/// Removes the temporaries of killed programs from those directories.
void check_outputs(std::span<const Output* const> outputs);

/// Throws UsageError where `output` is a file that has been read by now.
void check_is_not_read(const Output& output);

/// The `output` for picture `number`; a film is the same for all. Throws UsageError where `count`
/// pictures share a name.
[[nodiscard]] Output numbered(Output output, std::size_t number, std::size_t count);
/// Checks for all pictures of a sequence, before the first is written, that no output is another or
/// is read. `of_pictures`: outputs of each picture; `of_run`: those of the whole run.
void check_numbered(std::span<const Output* const> of_pictures,
                    std::span<const Output* const> of_run, std::size_t count);

/// `--hash`: prints a picture's digest to standard output, a line of the digest, what it is of, and
/// the picture's number where there are many.
void print_hash(const Digest& digest, std::string_view what, std::optional<std::size_t> number);
/// Throws UsageError where one of `outputs` is standard output, which has no room for both.
void check_hash(std::span<const Output* const> outputs);

/// The files of one picture, or of one run: none is seen before commit(), then all are.
class OutputFiles {
 public:
  /// A file to write to. Requires that `output` is asked for. Throws Error{io}.
  [[nodiscard]] io::AtomicFile& begin(const Output& output);
  void commit();

 private:
  std::list<io::AtomicFile> files_;
};

/// The kinds of image that a file can hold.
using ImageOfFile =
    std::variant<ImageView<const Rgba8>, ImageView<const Vec4>, ImageView<const Vec3>,
                 ImageView<const Vec2>, ImageView<const float>, ImageView<const std::int64_t>,
                 ImageView<const std::int32_t>>;
/// Writes an image. Requires that `format` has such pixels.
void write_image(io::AtomicFile& file, Format format, const ImageOfFile& image, int threads = 1);

}  // namespace rastrum::cli
