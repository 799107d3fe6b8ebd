// JSON to a file, whole or not at all.
#pragma once

#include <filesystem>

#include <nlohmann/json_fwd.hpp>

#include <rastrum/io.hpp>

namespace rastrum::cli {

/// Both throw Error{io} naming the file; the first leaves the commit to the caller.
void write_json(io::AtomicFile& file, const nlohmann::ordered_json& value);
void write_json(const std::filesystem::path& file, const nlohmann::ordered_json& value);

}  // namespace rastrum::cli
