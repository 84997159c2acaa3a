#include "io/files/tour_stations.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/support/temporary_file.h"

namespace patrol::io::tour_stations_test {
namespace {

std::vector<TourStation> load(const std::string& text) {
  const test::TemporaryFile file("stations.csv", text);
  return load_tour_stations(file.path());
}

/// From the file's name on.
std::string complaint(const std::string& text) {
  try {
    load(text);
  } catch (const InputError& error) {
    const std::string what = error.what();
    return what.substr(what.find("stations.csv"));
  }
  return "";
}

TEST(TourStations, ColumnsComeInAnyOrderAndFourMayBeMissing) {
  const std::vector<TourStation> stations = load("y,name,x\n2.5,valve,-1\n");
  ASSERT_EQ(stations.size(), 1u);
  EXPECT_EQ(stations[0].name, "valve");
  EXPECT_EQ(stations[0].x, -1.0);
  EXPECT_EQ(stations[0].y, 2.5);
  EXPECT_EQ(stations[0].service_s, 0.0);
  EXPECT_TRUE(std::isinf(stations[0].latest_s));
  EXPECT_EQ(stations[0].line, 2);
}

TEST(TourStations, EmptyCellsAreDefaultsAndTheRestIsRead) {
  const std::vector<TourStation> stations =
      load("name,x,y,service_s,earliest_s,latest_s,priority\na,0,0,10,60,120,-2\nb,1,1,,,,\n");
  EXPECT_EQ(stations[0].service_s, 10.0);
  EXPECT_EQ(stations[0].earliest_s, 60.0);
  EXPECT_EQ(stations[0].latest_s, 120.0);
  EXPECT_EQ(stations[0].priority, -2);
  EXPECT_EQ(stations[1].earliest_s, 0.0);
  EXPECT_TRUE(std::isinf(stations[1].latest_s));
  EXPECT_EQ(stations[1].priority, 0);
}

TEST(TourStations, NamesMayBeQuotedAndFilesMayComeFromASpreadsheet) {
  const std::vector<TourStation> stations = load("\xEF\xBB\xBFname,x,y\r\n\"ring 7, \"\"left\"\"\",1,2\r\n\r\n");
  ASSERT_EQ(stations.size(), 1u);
  EXPECT_EQ(stations[0].name, "ring 7, \"left\"");
}

TEST(TourStations, ColumnsMayHaveCapitalsAndUtf16IsRefusedByName) {
  EXPECT_EQ(load("Name,X,Y\na,1,2\n")[0].y, 2.0);
  EXPECT_EQ(complaint(std::string("\xFF\xFEn\0a\0", 6)), "stations.csv:1: is encoded as UTF-16: must be UTF-8");
}

TEST(TourStations, WhatIsWrongIsNamedWithItsLineAndColumn) {
  const std::string header = "name,x,y,service_s,earliest_s,latest_s,priority\n";
  EXPECT_EQ(complaint("name,x\na,1\n").substr(0, 29), "stations.csv:1: y: is missing");
  EXPECT_EQ(complaint("name,x,y,z\n").substr(0, 33), "stations.csv:1: z: unknown column");
  EXPECT_EQ(complaint("name,x,y,x\n"), "stations.csv:1: x: duplicate column");
  EXPECT_EQ(complaint("name,x,y\n\nb,1\n"), "stations.csv:3: has 2 cells, must have 3");
  EXPECT_EQ(complaint("name,x,y\nb,one,2\n"), "stations.csv:2: x: one: must be a number");
  EXPECT_EQ(complaint("name,x,y\nb,nan,2\n"), "stations.csv:2: x: nan: must be a number");
  EXPECT_EQ(complaint("name,x,y\nb,1,\n"), "stations.csv:2: y: is empty");
  EXPECT_EQ(complaint("name,x,y\n ,1,2\n"), "stations.csv:2: name: is empty");
  EXPECT_EQ(complaint("name,x,y\nb,1,2\nb,3,4\n"), "stations.csv:3: name: b: duplicate");
  EXPECT_EQ(complaint("name,x,y\n\"b,1,2\n"), "stations.csv:2: a quotation mark is not closed");
  EXPECT_EQ(complaint(header + "b,1,2,-1,,,\n"), "stations.csv:2: service_s: -1: must be in [0, 10000000]");
  EXPECT_EQ(complaint(header + "b,1,2,,9,8,\n"), "stations.csv:2: latest_s: 8: must not be before earliest_s = 9");
  EXPECT_EQ(complaint(header + "b,1,2,,,,1.5\n"), "stations.csv:2: priority: 1.5: must be an integer");
  EXPECT_EQ(complaint("name,x,y\nT\xFCr,1,2\n"), "stations.csv:2: name: is not valid UTF-8");
  EXPECT_EQ(complaint("name,x,y\nT\xC3\xBCr,1,2\n"), "");
  EXPECT_EQ(complaint(header), "stations.csv: contains no stations");
  EXPECT_EQ(complaint(""), "stations.csv: contains no stations");
}

TEST(TourStations, AHeadingIsOptional) {
  const std::vector<TourStation> stations = load("name,x,y,heading_deg\na,1,2,-90\nb,1,2,\n");
  ASSERT_EQ(stations.size(), 2u);
  EXPECT_EQ(stations[0].heading_deg, -90.0);
  EXPECT_FALSE(stations[1].heading_deg);
  EXPECT_EQ(complaint("name,x,y,heading_deg\na,1,2,400\n"), "stations.csv:2: heading_deg: 400: must be in [-360, 360]");
}

TEST(TourStations, MoreThanTwoHundredAreRefused) {
  std::string text = "name,x,y\n";
  for (int i = 0; i < 201; ++i) text += std::to_string(i) + ",0,0\n";
  EXPECT_EQ(complaint(text), "stations.csv:202: too many stations: at most 200 are allowed");
}

}  // namespace
}  // namespace patrol::io::tour_stations_test
