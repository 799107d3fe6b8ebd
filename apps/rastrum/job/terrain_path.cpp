// SPDX-License-Identifier: BSD-3-Clause
#include "terrain_path.hpp"

#include <optional>
#include <string>
#include <utility>

#include <nlohmann/json.hpp>

#include <rastrum/error.hpp>

#include "json_file.hpp"
#include "parse/arguments.hpp"
#include "path_keys.hpp"

namespace rastrum::cli {
namespace {

using terrain::TerrainCamera;

template <double TerrainCamera::*number>
constexpr PathColumn<TerrainCamera> kNumber{
    [](const TerrainCamera& c) { return c.*number; },
    [](TerrainCamera& c, double value) { c.*number = value; }, Tangent::curve};
constexpr PathColumn<TerrainCamera> kTerrainColumns[] = {
    kNumber<&TerrainCamera::x>,          kNumber<&TerrainCamera::y>,
    kNumber<&TerrainCamera::altitude>,   kNumber<&TerrainCamera::angle_rad>,
    kNumber<&TerrainCamera::horizon_px>, kNumber<&TerrainCamera::roll_rad>};

/// In degrees, as people write them, or in radians, which lose no bit.
void read_angle(JsonFields& fields, const char* degrees, const char* radians, double& angle_rad) {
  const std::optional<double> deg = fields.number(degrees), rad = fields.number(radians);
  if (deg && rad)
    fields.fail(radians, std::string("gives what '").append(degrees).append("' gives, too"));
  if (deg) angle_rad = *deg * kDegree;
  if (rad) angle_rad = *rad;
}

TerrainPathKey read_terrain_key(const JsonFields::Element& element, const TerrainPathKey& before,
                                bool first) {
  JsonFields fields(*element.value, element.place);
  TerrainPathKey key = before;
  TerrainCamera& c = key.camera;
  key.time_s = read_key_time(fields, first ? std::nullopt : std::optional(before.time_s));
  if (const auto position = fields.numbers("position", 2)) {
    c.x = (*position)[0];
    c.y = (*position)[1];
  }
  c.altitude = fields.number("altitude").value_or(c.altitude);
  read_angle(fields, "angle", "angle_rad", c.angle_rad);
  c.horizon_px = fields.number("horizon").value_or(c.horizon_px);
  read_angle(fields, "roll", "roll_rad", c.roll_rad);
  fields.finish();
  return key;
}

}  // namespace

TerrainPath read_path(const std::filesystem::path& file, const TerrainCamera& base) {
  auto [keys, interpolation] =
      read_path_keys(file, TerrainPathKey{.camera = base}, read_terrain_key);
  return {std::move(keys), interpolation, kTerrainColumns};
}

void write_path(const std::filesystem::path& file, std::span<const TerrainPathKey> keys) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const TerrainPathKey& key : keys) {
    const TerrainCamera& c = key.camera;
    list.push_back({{"time", key.time_s},
                    {"position", {c.x, c.y}},
                    {"altitude", c.altitude},
                    {"angle_rad", c.angle_rad},
                    {"horizon", c.horizon_px},
                    {"roll_rad", c.roll_rad}});
  }
  write_json(file, {{"keys", std::move(list)}});
}

}  // namespace rastrum::cli
