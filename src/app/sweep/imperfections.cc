#include "app/sweep/imperfections.h"

#include <utility>

namespace patrol::app {
namespace {

bool has_belts(const Scenario&, const ScenarioFiles& files) { return files.robot.tracks.has_value(); }

template <IsSensorMessage Message>
bool has_sensor(const Scenario& scenario, const ScenarioFiles& files) {
  return sim::is_enabled<Message>(scenario.sensors) && is_fitted<Message>(files.robot);
}

std::vector<Imperfection> imperfections_of_sensors() {
  std::vector<Imperfection> all;
  Sensors::for_each([&]<typename Message>(std::type_identity<Message>) {
    for (ErrorSource& source : error_sources<Message>()) {
      all.push_back({std::move(source.name), std::move(source.overrides), has_sensor<Message>});
    }
  });
  return all;
}

std::vector<Imperfection> other_imperfections() {
  return {
      {"belts: slip (friction 2)", {"track_drive.friction=2"}, has_belts},
      {"latency of all sensors", {"sensors.lidar.latency_s=0", "sensors.imu.latency_s=0", "sensors.joint_encoders.latency_s=0",
                                  "sensors.foot_contact.latency_s=0", "sensors.hall.latency_s=0", "sensors.uwb.latency_s=0",
                                  "sensors.ultrasonic.latency_s=0", "sensors.depth_camera.latency_s=0", "sensors.tdlas.latency_s=0",
                                  "sensors.gnss.latency_s=0"}},
      {"people and vehicles", {"actors=[]"}},
      {"faults", {"faults=[]"}},
      {"put down off the start", {"start.ahead_m=0", "start.left_m=0", "start.turn_deg=0"}},
      {"map: cells of 5 cm (2.5 cm)", {"stack.slam.resolution_m=0.025", "stack.graph.tracking.resolution_m=0.025"}},
  };
}

}  // namespace

const std::vector<Imperfection>& imperfections() {
  static const std::vector<Imperfection> kAll = [] {
    std::vector<Imperfection> all = imperfections_of_sensors();
    for (Imperfection& imperfection : other_imperfections()) all.push_back(std::move(imperfection));
    return all;
  }();
  return kAll;
}

}  // namespace patrol::app
