#include "app/scenario/tour.h"

#include <array>
#include <charconv>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "core/geometry/angles.h"

namespace patrol::app {

Pose2 PlanarPoseSettings::pose() const { return {x_m, y_m, to_rad(heading_deg)}; }

Route route_of(const TourSettings& tour) {
  Route route;
  for (const TourStationSettings& from : tour.stations) {
    const int number = static_cast<int>(route.stations.size()) + 1;
    const bool is_last = route.stations.size() + 1 == tour.stations.size();
    route.stations.push_back({.number = number,
                              .name = from.name.empty() ? fmt::format("station_{}", number) : from.name,
                              .type = is_last || from.type == "home" ? StationType::kHome : StationType::kPass,
                              .T_route_body = {from.x_m, from.y_m, to_rad(from.heading_deg)},
                              .accuracy_m = from.accuracy_m});
  }
  return route;
}

PlanarPoseSettings parse_pose(const std::string& text, const char* option, const PlanarPoseSettings& from) {
  std::array<double, 3> numbers{};
  std::size_t count = 0;
  const char* at = text.data();
  const char* const end = at + text.size();
  while (count < numbers.size()) {
    const auto [next, error] = std::from_chars(at, end, numbers[count]);
    if (error != std::errc() || !std::isfinite(numbers[count])) break;
    ++count;
    at = next;
    if (at == end || *at != ',') break;
    ++at;
  }
  if (at != end || count < 2 || text.ends_with(',') || std::abs(numbers[2]) > 360.0)
    throw InputError(fmt::format("{} {}: must be X,Y or X,Y,DEG in the site, m and degrees", option, text));
  const double toward_deg = to_deg(std::atan2(numbers[1] - from.y_m, numbers[0] - from.x_m));
  return {.x_m = numbers[0], .y_m = numbers[1], .heading_deg = count == 3 ? numbers[2] : toward_deg};
}

std::vector<std::string> overrides_of(const TourSettings& tour) {
  std::string stations;
  for (const TourStationSettings& station : tour.stations) {
    stations += fmt::format("{}{{name: \"{}\", type: {}, x_m: {}, y_m: {}, heading_deg: {}, accuracy_m: {}}}",
                            stations.empty() ? "" : ", ", station.name, station.type, station.x_m, station.y_m,
                            station.heading_deg, station.accuracy_m);
  }
  return {"mission=\"\"", "stack.mission_type=gas", "course.optimal_time_s=0",
          fmt::format("tour.start={{x_m: {}, y_m: {}, heading_deg: {}}}", tour.start.x_m, tour.start.y_m,
                      tour.start.heading_deg),
          fmt::format("tour.stations=[{}]", stations)};
}

}  // namespace patrol::app
