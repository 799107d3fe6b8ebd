#include <rastrum/io/large_file.hpp>

#include <algorithm>
#include <system_error>

#include <rastrum/error.hpp>

namespace rastrum::io {

LargeFile::LargeFile(const std::filesystem::path& file)
    : name_(file.string()),
      file_(file),
      mapped_(file),
      lost_(mapped_.bytes().data(), mapped_.bytes().size()) {}

std::unique_ptr<LargeFile> LargeFile::open(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  for (char& c : extension)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c + ('a' - 'A'));
  if (extension == ".ply") return open_large_ply(file);
  if (extension == ".stl") return open_large_stl(file);
  if (extension == ".glb") return open_large_glb(file);
  throw Error(Errc::unsupported,
              file.string() + ": out of core there are binary files alone: .ply, .stl, .glb");
}

void LargeFile::check_length() const {
  std::error_code ignored;
  const std::uintmax_t now = std::filesystem::file_size(file_, ignored);
  if (!ignored && now < mapped_.bytes().size())
    throw Error(Errc::io, name_ + ": has become shorter while it was drawn (" +
                              std::to_string(mapped_.bytes().size()) + " bytes to " +
                              std::to_string(now) + ")");
  if (lost_.any())
    throw Error(Errc::io, name_ +
                              ": could not be read while it was drawn: its disk or network has "
                              "failed, or it was shorter for a time");
}

void LargeFile::fail(const std::string& message) const {
  check_length();  // zeros in the place of what was there are wrong, too
  throw Error(Errc::bad_format, std::string(name_).append(": ").append(message));
}

void LargeFile::refuse(const std::string& message) const {
  check_length();
  throw Error(Errc::unsupported, std::string(name_).append(": out of core: ").append(message));
}

std::size_t VertexSet::count() {
  std::size_t n = 0;
  for (std::size_t w = 0; w < bits_.size(); ++w) {
    if (w % 8 == 0) places_[w / 8] = static_cast<std::uint32_t>(n);
    n += static_cast<std::size_t>(std::popcount(bits_[w]));
  }
  return n;
}

std::uint32_t VertexSet::place(std::uint64_t v) const {
  const std::size_t word = v / 64;
  auto n = places_[v / 512];
  for (std::size_t w = word / 8 * 8; w < word; ++w)
    n += static_cast<std::uint32_t>(std::popcount(bits_[w]));
  const std::uint64_t below = (std::uint64_t{1} << v % 64) - 1;
  return n + static_cast<std::uint32_t>(std::popcount(bits_[word] & below));
}

}  // namespace rastrum::io
