#pragma once

#include <string>
#include <vector>

#include "core/event.h"

namespace patrol::app {

/// Stations and goals that events name in their subject. Events with other subjects are not scored.
class EventSubjects {
 public:
  EventSubjects(std::vector<std::string> stations, std::vector<std::string> goals);

  /// Returns a warning of an event about a station or goal that the run does not have; empty without one, and after the
  /// first one about a station or a goal. A goal that the robot saves is known from then on.
  std::string warning_of(const Event& event);

 private:
  /// Subjects of one kind.
  struct Group {
    std::vector<std::string> names;
    bool was_reported = false;
  };

  Group stations_, goals_;
};

}  // namespace patrol::app
