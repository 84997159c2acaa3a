#pragma once

#include "render/scene/frame.h"

/// Colors with one meaning each, in the world and in the map.
namespace patrol::render {

inline constexpr Color kTruthColor{46, 204, 84};
inline constexpr Color kEstimateColor{255, 140, 20};
inline constexpr Color kPlanColor{66, 150, 255};
inline constexpr Color kScanColor{255, 48, 112};
inline constexpr Color kParticleColor{180, 60, 220};
inline constexpr Color kRobotColor{220, 30, 30};
inline constexpr Color kGasColor{196, 232, 64};
inline constexpr Color kFindingColor{255, 214, 64};
inline constexpr Color kTextColor{245, 247, 250};
inline constexpr Color kAlarmColor{255, 96, 72};
inline constexpr Color kPanelColor{12, 16, 24};

}  // namespace patrol::render
