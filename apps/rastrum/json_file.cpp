#include "json_file.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string>

#include <nlohmann/json.hpp>

#include <rastrum/core/error.hpp>
#include <rastrum/io/atomic_file.hpp>

namespace rastrum::cli {

void write_json(const std::filesystem::path& file, const nlohmann::ordered_json& value) {
  // A file name need not be UTF-8, JSON must.
  const std::string text =
      value.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
  if (file == "-") {
    if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0)
      throw Error(Errc::io,
                  std::string("standard output cannot be written: ") + std::strerror(errno));
    return;
  }
  io::AtomicFile out(file);
  out.write(text.data(), text.size());
  out.commit();
}

}  // namespace rastrum::cli
