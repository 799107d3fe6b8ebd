// SPDX-License-Identifier: BSD-3-Clause
#include "output.hpp"

#include <unistd.h>

#include <cstdio>
#include <map>
#include <system_error>
#include <utility>
#include <vector>

#include <rastrum/error.hpp>
#include <rastrum/io.hpp>
#include <rastrum/io/files.hpp>

namespace rastrum::cli {
namespace {

namespace fs = std::filesystem;

const char* extension(Format format) {
  constexpr const char* kExtensions[] = {".png", ".exr", ".npy", ".ply", ".json", ".mp4"};
  return kExtensions[static_cast<std::size_t>(format)];
}

/// One name per file, whether it exists or not.
fs::path resolved(const fs::path& file) {
  std::error_code error;
  const fs::path absolute = fs::absolute(file, error);
  const fs::path canonical = fs::weakly_canonical(absolute, error);
  return error ? absolute.lexically_normal() : canonical;
}

/// The output files of a run. Each belongs to one option, and none is read.
class Written {
 public:
  void add(const Output& output) {
    std::optional<io::FileId> id;
    if (!output.to_stdout()) id = io::id_of(output.file);
    check_is_not_read(output);
    const auto [name, is_new] = names_.try_emplace(resolved(output.file), output.option);
    if (!is_new) refuse(output, name->second);
    if (!id) return;
    // Hard links name one file, too. Between the pictures of one option they are harmless.
    const auto file = files_.try_emplace(*id, output.option).first;
    if (file->second != output.option) refuse(output, file->second);
  }

 private:
  [[noreturn]] static void refuse(const Output& output, const std::string& other) {
    throw UsageError(output.option,
                     output.name() + " is also the file of " + other + "; give each its own file");
  }
  std::map<fs::path, std::string> names_;
  std::map<io::FileId, std::string> files_;
};

void check_standard_output(const Output& output) {
  if (output.format != Format::json && ::isatty(STDOUT_FILENO) != 0)
    throw UsageError(output.option,
                     "standard output is a terminal, which cannot show the bytes of a " +
                         std::string(extension(output.format)) +
                         " file: send them on, as in `rastrum … | program`, or name a file");
}

void check_file(const Output& output) {
  if (const std::string why = io::why_not_writable(output.file); !why.empty())
    throw Error(Errc::io,
                output.option + ": " + output.file.string() + " cannot be written: " + why);
  io::remove_abandoned(output.file.has_parent_path() ? output.file.parent_path() : fs::path("."));
}

}  // namespace

void check_is_not_read(const Output& output) {
  if (output && !output.to_stdout() && io::was_read(output.file))
    throw UsageError(
        output.option,
        output.name() + " is an input of this run, which would be lost: name another file");
}

std::string Output::name() const {
  return to_stdout() ? "standard output" : file.string();
}

Output parse_output(std::string_view option, const std::string& file,
                    const std::vector<Format>& formats, std::optional<Format> format) {
  if (file == "-" || file == "/dev/stdout")
    return {std::string(option), "-", format.value_or(*formats.begin())};
  const fs::path path(file);
  const std::string given = lower(path.extension().string());
  std::string known;
  for (const Format f : formats) {
    if (given == extension(f)) {
      if (format && *format != f)
        throw UsageError(option, "the name of " + file + " says " + given + ", the option " +
                                     extension(*format) + ": leave the option out");
      return {std::string(option), path, f};
    }
    if (f == Format::mp4)
      known.append(" (with --path also .mp4)");
    else
      known.append(known.empty() ? "" : ", ").append(extension(f));
  }
  if (format && !file.empty()) return {std::string(option), path, *format};
  throw UsageError(option, "the name of the file must end in " + known + ", got '" + file + "'");
}

Option add_output(Parser& app, const char* name, const std::string& help, Output& output,
                  std::vector<Format> formats) {
  return app.add(name, "FILE", help,
                 [name, &output, formats = std::move(formats)](const std::string& file) {
                   output = parse_output(name, file, formats);
                 });
}

void check_outputs(std::span<const Output* const> outputs, bool hash) {
  Written written;
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    if (!*outputs[i]) continue;
    written.add(*outputs[i]);
    if (outputs[i]->to_stdout())
      check_standard_output(*outputs[i]);
    else
      check_file(*outputs[i]);
  }
  for (const Output* const output : outputs)
    if (hash && output->to_stdout())
      throw UsageError("--hash", "prints to standard output, and so does " + output->option +
                                     "; give that a file's name");
}

NumberedName::NumberedName(std::string_view option, std::string_view pattern) {
  const auto refuse = [&] {
    throw UsageError(option,
                     "expected a name with one %d or %04d in it (%% for a percent sign), got '" +
                         std::string(pattern) + "'");
  };
  constexpr std::size_t kWidest = 20;
  for (std::size_t i = 0; i < pattern.size(); ++i) {
    std::string& part = has_number_ ? after_ : before_;
    if (pattern[i] != '%') {
      part += pattern[i];
      continue;
    }
    if (++i < pattern.size() && pattern[i] == '%') {
      part += '%';
      continue;
    }
    if (has_number_) refuse();
    has_number_ = true;
    zeros_ = i < pattern.size() && pattern[i] == '0';
    for (; i < pattern.size() && pattern[i] >= '0' && pattern[i] <= '9' && width_ <= kWidest; ++i)
      width_ = width_ * 10 + static_cast<std::size_t>(pattern[i] - '0');
    if (i >= pattern.size() || pattern[i] != 'd' || width_ > kWidest) refuse();
  }
}

std::string NumberedName::at(std::size_t number) const {
  if (!has_number_) return before_;
  std::string digits = std::to_string(number);
  if (digits.size() < width_) digits.insert(0, width_ - digits.size(), zeros_ ? '0' : ' ');
  return before_ + digits + after_;
}

Output numbered(Output output, std::size_t number, std::size_t count) {
  if (!output || output.format == Format::mp4) return output;
  const NumberedName name(output.option, output.file.string());
  if (!name.has_number() && count > 1)
    throw UsageError(output.option, "there are " + std::to_string(count) +
                                        " pictures: number them, as in frame_%04d" +
                                        output.file.extension().string());
  output.file = name.at(number);
  return output;
}

void check_numbered(std::span<const Output* const> of_pictures,
                    std::span<const Output* const> of_run, std::size_t count) {
  Written written;
  for (const Output* const output : of_run)
    if (*output) written.add(*output);
  for (const Output* const output : of_pictures)
    for (std::size_t i = 0; *output && i < (output->format == Format::mp4 ? 1 : count); ++i)
      written.add(numbered(*output, i, count));
}

void add_path_options(Parser app, RunOptions& a, const std::string& fps_help) {
  add(app, "--path", "FILE",
      "draw a picture for each moment of the camera path in FILE (docs/window.md): -o "
      "'frame_%04d.png' or, through ffmpeg, -o flight.mp4",
      [&a](const std::string& s) { a.path = s; });
  add_number_that(
      app, "--fps", "N", fps_help, a.fps, [](double fps) { return fps > 0 && fps <= 1000; },
      "must be greater than 0 and at most 1000");
}

void add_frames_option(Parser app, RunOptions& a) {
  add_integer(app, "--frames", "N",
              "draw N times; --stats gives median, minimum and maximum (default: 1)", a.frames, 1,
              1000000);
}

void add_hash_option(Parser app, RunOptions& a) {
  app.add_flag("--hash", a.hash,
               "print the digest (SHA-256, docs/conventions.md) of the pixels of each picture that "
               "is written; if none is, of the 8-bit colours");
}

}  // namespace rastrum::cli
