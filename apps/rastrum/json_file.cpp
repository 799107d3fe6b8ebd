#include "json_file.hpp"

#include <string>

#include <nlohmann/json.hpp>

namespace rastrum::cli {

void write_json(io::AtomicFile& file, const nlohmann::ordered_json& value) {
  // A file name need not be UTF-8, JSON must.
  const std::string text =
      value.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
  file.write(text.data(), text.size());
}

void write_json(const std::filesystem::path& file, const nlohmann::ordered_json& value) {
  io::AtomicFile out(file);
  write_json(out, value);
  out.commit();
}

}  // namespace rastrum::cli
