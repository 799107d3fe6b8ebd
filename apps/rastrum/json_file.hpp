// JSON to a file, whole or not at all, or to standard output.
#pragma once

#include <filesystem>

#include <nlohmann/json_fwd.hpp>

namespace rastrum::cli {

/// `file` "-" is standard output. Throws Error{io} naming the file.
void write_json(const std::filesystem::path& file, const nlohmann::ordered_json& value);

}  // namespace rastrum::cli
