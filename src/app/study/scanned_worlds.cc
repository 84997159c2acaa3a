#include "app/study/scanned_worlds.h"

namespace patrol::app {

const std::vector<ScannedWorld>& scanned_worlds() {
  static const std::vector<ScannedWorld> worlds = {
      {.name = "tunnel",
       .scenario = "worlds/tunnel/scenarios/navigate.yaml",
       .step_deg = 0.18,
       .scanners_m = {{6.5, -1.5},  // sees both sides of the notches of the charging post
                      {18.0, 1.0},
                      {31.0, 1.5},
                      {44.0, -1.5},
                      {57.0, 1.5},
                      {70.0, -1.5},
                      {83.0, 1.0},
                      {96.0, -1.0},
                      {109.0, 2.0},
                      {122.0, 1.0},
                      {135.0, 1.95},
                      {148.0, 5.0}},
       .roads_m = {{{4.0, 0.0}, {80.0, 0.0}, {121.1, 0.2}, {128.1, 1.0}, {142.0, 2.9}, {147.0, 4.1}}},
       .half_road_m = 2.5,
       .guest_scan = 4,
       .person_m = {62.0, 2.0},
       .truck_m = {50.0, 0.0},
       .truck_yaw_deg = 180.0},
      {.name = "substation",
       .scenario = "worlds/substation/scenarios/navigate.yaml",
       .step_deg = 0.1,
       .elevation_min_deg = -40.0,
       .scanners_m = {{7.5, 10.5},  // by the rule of ScannerChoice, scanner_choice_test.cc
                      {45.0, 6.0},
                      {82.5, 6.0},
                      {114.0, 19.5},
                      {84.0, 33.0},
                      {7.5, 49.5},
                      {37.5, 55.5},
                      {64.5, 55.5},
                      {106.5, 55.5},
                      {19.5, 82.5},
                      {58.5, 84.0},
                      {97.5, 82.5}},
       .roads_m = {{{7.0, 7.0}, {113.0, 7.0}, {113.0, 83.0}, {7.0, 83.0}, {7.0, 7.0}},
                   {{62.5, 34.0}, {110.5, 34.0}},
                   {{60.0, 36.5}, {60.0, 80.5}},
                   {{9.5, 55.5}, {110.5, 55.5}}},
       .half_road_m = 1.5,
       .guest_scan = 1,
       .person_m = {40.0, 6.0},
       .truck_m = {58.0, 7.0},
       .truck_yaw_deg = 0.0}};
  return worlds;
}

}  // namespace patrol::app
