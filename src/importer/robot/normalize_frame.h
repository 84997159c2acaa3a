#pragma once

#include <vector>

#include "importer/robot/normalize.h"
#include "importer/robot/robot_layout.h"

namespace patrol::importer {

/// Chooses the base: the root, without the massless links above the first one with mass, shapes or several children.
void choose_base(RobotLayout& layout, const NormalizeOptions& options, std::vector<Assumption>& rows);

/// Chooses the frame base_link of a robot on wheels: the frame of the base link, level, with the axles along y and
/// between the wheels. Moves the wheels to this frame.
void choose_wheeled_frame(RobotLayout& layout, const NormalizeOptions& options, std::vector<Assumption>& rows);

/// Chooses the frame base_link of a robot with legs: level, x along the file's x or by option, in the middle of the
/// first joints of the legs.
void choose_legged_frame(RobotLayout& layout, const NormalizeOptions& options, std::vector<Assumption>& rows);

}  // namespace patrol::importer
