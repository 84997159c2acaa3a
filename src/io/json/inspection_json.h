#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "core/inspection_result.h"

namespace patrol::io {

/// Converts inspection results to JSON, for the monitoring server and for files. SI units, frame `map`. Values that
/// could not be computed are null; levels are written as names. The fields of a water body are present only if one was
/// found.
nlohmann::json to_json(const LiningResult& result);
nlohmann::json to_json(const WaterResult& result);

/// Convert JSON to inspection results. `place` is the prefix of error messages. Throw InputError with the key and the
/// rule if a member is missing, unknown, of the wrong type or out of range.
LiningResult lining_from_json(const std::string& place, const nlohmann::json& json);
WaterResult water_from_json(const std::string& place, const nlohmann::json& json);

/// Converts a pose to {"x": m, "y": m, "yaw": rad}.
nlohmann::json to_json(const Pose2& T_map_body);
Pose2 pose_from_json(const std::string& place, const nlohmann::json& json);

}  // namespace patrol::io
