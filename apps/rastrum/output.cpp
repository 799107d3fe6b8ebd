#include "output.hpp"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <system_error>
#include <vector>

#include <rastrum/error.hpp>
#include <rastrum/io.hpp>

#include "arguments.hpp"

namespace rastrum::cli {
namespace {

namespace fs = std::filesystem;

const char* extension(Format format) {
  switch (format) {
    case Format::png:
      return ".png";
    case Format::exr:
      return ".exr";
    case Format::npy:
      return ".npy";
    case Format::ply:
      return ".ply";
    case Format::json:
      return ".json";
    case Format::mp4:
      return ".mp4";
  }
  return "";
}

std::string lower(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c + ('a' - 'A'));
  return text;
}

/// One name for each file, whether it exists or not.
fs::path resolved(const fs::path& file) {
  std::error_code error;
  const fs::path absolute = fs::absolute(file, error);
  const fs::path canonical = fs::weakly_canonical(absolute, error);
  return error ? absolute.lexically_normal() : canonical;
}

void check_standard_output(const Output& output) {
  if (output.format != Format::json && ::isatty(STDOUT_FILENO) != 0)
    throw UsageError(output.option,
                     "standard output is a terminal, which cannot show the bytes of a " +
                         std::string(extension(output.format)) +
                         " file: send them on, as in `rastrum … | program`, or name a file");
}

void check_directory(const Output& output) {
  const auto fail = [&](const std::string& why) {
    throw Error(Errc::io,
                output.option + ": " + output.file.string() + " cannot be written: " + why);
  };
  std::error_code ignored;
  if (fs::is_directory(output.file, ignored)) fail("it is a directory");
  const fs::path parent = output.file.has_parent_path() ? output.file.parent_path() : fs::path(".");
  if (!fs::is_directory(parent, ignored))
    fail("there is no directory " + parent.string() + "; create it first");
  // What exists and is no regular file (a device, a pipe) is written in place.
  const bool special =
      fs::exists(output.file, ignored) && !fs::is_regular_file(output.file, ignored);
  if (!special && ::access(parent.c_str(), W_OK) != 0)
    fail(parent.string() + ": " + std::strerror(errno));
  io::remove_abandoned(parent);
}

}  // namespace

std::string Output::name() const {
  return to_stdout() ? "standard output" : file.string();
}

Output parse_output(std::string_view option, const std::string& file,
                    std::initializer_list<Format> formats, std::optional<Format> format) {
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

void check_outputs(std::span<const Output* const> outputs) {
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    if (!*outputs[i]) continue;
    for (std::size_t j = 0; j < i; ++j)
      if (*outputs[j] && resolved(outputs[i]->file) == resolved(outputs[j]->file))
        throw UsageError(outputs[i]->option, outputs[i]->name() + " is also what " +
                                                 outputs[j]->option +
                                                 " is written to; give each its own");
    if (outputs[i]->to_stdout())
      check_standard_output(*outputs[i]);
    else
      check_directory(*outputs[i]);
  }
}

void print_hash(const Digest& digest, std::string_view what, std::optional<std::size_t> number) {
  std::string line = digest.hex().append("  ").append(what);
  if (number) line.append(" ").append(std::to_string(*number));
  std::puts(line.c_str());
}

void check_hash(std::span<const Output* const> outputs) {
  for (const Output* const output : outputs)
    if (output->to_stdout())
      throw UsageError("--hash", "is printed to standard output, and so is what " + output->option +
                                     " asks for: name a file there");
}

io::AtomicFile& OutputFiles::begin(const Output& output) {
  return output.to_stdout() ? files_.emplace_back(io::StandardOutput{})
                            : files_.emplace_back(output.file);
}

void OutputFiles::commit() {
  std::vector<io::AtomicFile*> all;
  for (io::AtomicFile& file : files_) all.push_back(&file);
  io::AtomicFile::commit(all);
  files_.clear();
}

void write_image(io::AtomicFile& file, Format format, const ImageOfFile& image, int threads) {
  std::visit(
      [&](const auto& pixels) {
        if constexpr (requires { io::write_png(file, pixels, threads); }) {
          io::write_png(file, pixels, threads);
        } else {
          if constexpr (requires { io::write_exr(file, pixels); })
            if (format == Format::exr) return io::write_exr(file, pixels);
          io::write_npy(file, pixels);
        }
      },
      image);
}

}  // namespace rastrum::cli
