#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "core/inspection_result.h"

namespace patrol::io {

/// What the inspection found, as JSON: for the monitoring platform and for files. SI units, `map`; a figure that could not be computed
/// is null; levels go by their names. Of water, what was not found is left out.
nlohmann::json to_json(const LiningResult& result);
nlohmann::json to_json(const WaterResult& result);

/// And backwards. `place` is what an error names. Throw InputError with the key and the rule when anything is missing, unknown, of the
/// wrong kind or out of its range.
LiningResult lining_from_json(const std::string& place, const nlohmann::json& json);
WaterResult water_from_json(const std::string& place, const nlohmann::json& json);

/// {"x": m, "y": m, "yaw": rad}.
nlohmann::json to_json(const Pose2& T_map_body);
Pose2 pose_from_json(const std::string& place, const nlohmann::json& json);

}  // namespace patrol::io
