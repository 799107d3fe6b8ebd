// SPDX-License-Identifier: BSD-3-Clause
#include "output_files.hpp"

#include <cstdio>
#include <string>
#include <vector>

namespace rastrum::cli {

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

void print_hash(const Digest& digest, std::string_view what, std::optional<std::size_t> number) {
  std::string line = digest.hex().append("  ").append(what);
  if (number) line.append(" ").append(std::to_string(*number));
  std::puts(line.c_str());
}

}  // namespace rastrum::cli
