#pragma once

namespace patrol::inspect {

/// What navigation says about the goal it was given.
enum class NavigationFeedback { kDriving, kArrived, kFailed };

}  // namespace patrol::inspect
