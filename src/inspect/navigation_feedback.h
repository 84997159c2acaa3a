#pragma once

namespace patrol::inspect {

/// State of the navigation to the current goal.
enum class NavigationFeedback { kDriving, kArrived, kFailed };

}  // namespace patrol::inspect
