#include "io/yaml/settings_yaml.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/yaml/yaml_document.h"
#include "tests/support/temporary_file.h"

namespace patrol::io::settings_yaml_test {
namespace {

using test::read_bytes, test::TemporaryFile, test::TemporaryFolder;
using ::testing::ElementsAre, ::testing::HasSubstr, ::testing::StartsWith;

struct Lidar {
  bool enabled = true;
  std::string preset = "rplidar_s2";
  double range_noise_m = 0.03;
  int beams = 1600;

  static Lidar of_preset(const std::string& preset) {
    Lidar lidar;
    lidar.preset = preset;
    if (preset == "utm30lx") lidar.range_noise_m = 0.01, lidar.beams = 1081;
    return lidar;
  }
  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("enabled", self.enabled);
    visit("preset", self.preset, one_of({"rplidar_s2", "utm30lx"}));
    visit("range_noise_m", self.range_noise_m, at_least(0.0));
    visit("beams", self.beams, between(1, 100000));
  }
};

struct Leak {
  std::string at;
  double rate_g_s = 1.0;
  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("at", self.at);
    visit("rate_g_s", self.rate_g_s, at_least(0.0));
  }
};

struct Sensors {
  Lidar lidar;
  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("lidar", self.lidar);
  }
};

struct Scenario {
  std::string world = "street";
  std::uint64_t seed = 1;
  Sensors sensors;
  std::vector<Leak> leaks;
  std::vector<double> wind_mps = {1.0, 0.0};
  std::vector<std::string> tags;
  Expectations expect;
  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("world", self.world);
    visit("seed", self.seed);
    visit("sensors", self.sensors);
    visit("leaks", self.leaks);
    visit("wind_mps", self.wind_mps, between(-50.0, 50.0));
    visit("tags", self.tags);
    visit("expect", self.expect);
  }
};

Scenario load(const std::string& yaml, const std::vector<std::string>& overrides = {}) {
  const TemporaryFile file("a.yaml", yaml);
  return load_settings<Scenario>(file.path(), overrides);
}

/// The complaint, less the folder that the file lies in.
std::string complaint_about(const std::string& yaml, const std::vector<std::string>& overrides = {}) {
  const TemporaryFile file("a.yaml", yaml);
  try {
    load_settings<Scenario>(file.path(), overrides);
  } catch (const InputError& error) {
    const std::string what = error.what();
    EXPECT_EQ(what.find('\n'), std::string::npos) << "one line";
    const std::size_t at = what.find("a.yaml");
    return at == std::string::npos ? what : what.substr(at);
  }
  return "";
}

TEST(LoadSettings, TakesWhatIsSaidAndLeavesTheDefaults) {
  const Scenario scenario = load(
      "seed: 18446744073709551615\n"
      "sensors: {lidar: {range_noise_m: 0.05, enabled: no}}\n"
      "leaks:\n- {at: regulator_box_2, rate_g_s: 1.2}\n- {at: valve_well_3}\n"
      "wind_mps: [0.5, -2]\n"
      "tags: [a, b]\n");
  EXPECT_EQ(scenario.world, "street");
  EXPECT_EQ(scenario.seed, 18446744073709551615ULL);
  EXPECT_EQ(scenario.sensors.lidar.range_noise_m, 0.05);
  EXPECT_FALSE(scenario.sensors.lidar.enabled);
  EXPECT_EQ(scenario.sensors.lidar.beams, 1600);
  ASSERT_EQ(scenario.leaks.size(), 2U);
  EXPECT_EQ(scenario.leaks[0].rate_g_s, 1.2);
  EXPECT_EQ(scenario.leaks[1].rate_g_s, 1.0);
  EXPECT_THAT(scenario.wind_mps, ElementsAre(0.5, -2.0));
  EXPECT_THAT(scenario.tags, ElementsAre("a", "b"));
}

TEST(LoadSettings, AnEmptyMapIsAllDefaultsAndAnEmptyFileIsRefused) {
  EXPECT_EQ(load("{}\n").seed, 1U);
  for (const char* empty : {"", "\n", "# nothing\n", "---\n"})
    EXPECT_THAT(complaint_about(empty), StartsWith("a.yaml: is empty")) << empty;
}

TEST(LoadSettings, EmptyKeysOfOverridesAreRefused) {
  for (const char* path : {"sensors..lidar", ".seed", "seed."})
    EXPECT_THAT(complaint_about("{}\n", {fmt::format("{}=3", path)}),
                StartsWith(fmt::format("--set {0}=3: {0} has an empty key", path)));
}

TEST(LoadSettings, ASecondDocumentIsRefused) {
  EXPECT_THAT(complaint_about("seed: 2\n---\nseed: 3\n"), StartsWith("a.yaml:2: more than one YAML document"));
  EXPECT_THAT(complaint_about("{seed: 2}\nseed: 3\n"), StartsWith("a.yaml:2: "));
  EXPECT_EQ(load("---\nseed: 2\n...\n").seed, 2U);
}

TEST(LoadSettings, TooManyValuesAreRefusedAliasesCountedAsWhatTheyRepeat) {
  std::string list = "wind_mps: [";
  for (int i = 0; i < 250'000; ++i) list += "1,";
  EXPECT_THAT(complaint_about(list + "1]\n"), StartsWith("a.yaml:1: too many values: at most 200000 are allowed"));
  std::string laughs = "a: &a [1, 1, 1, 1, 1, 1, 1, 1, 1, 1]\n";
  for (char c = 'b'; c < 'i'; ++c) {
    const std::string one = fmt::format("*{}", static_cast<char>(c - 1));
    laughs += fmt::format("{0}: &{0} [{1}, {1}, {1}, {1}, {1}, {1}, {1}, {1}, {1}, {1}]\n", c, one);
  }
  EXPECT_THAT(complaint_about(laughs), HasSubstr("too many values"));
  EXPECT_THAT(complaint_about("tags: &a [*a]\n"), StartsWith("a.yaml:1: an alias refers to a node that contains it"));
  EXPECT_THAT(complaint_about("tags: " + std::string(100'000, '[')), StartsWith("a.yaml:1: "));
  EXPECT_THAT(load("tags: [&a b, *a]\n").tags, ElementsAre("b", "b"));
}

TEST(LoadSettings, AFileOverTheLimitIsRefused) {
  const TemporaryFolder folder;
  test::write_bytes(folder / "a.yaml", "seed: 1\n");
  std::filesystem::resize_file(folder / "a.yaml", kMaxYamlBytes + 1);
  EXPECT_THROW(load_settings<Scenario>(folder / "a.yaml", {}), InputError);
  std::filesystem::create_symlink("b.yaml", folder / "b.yaml");
  EXPECT_THROW(load_settings<Scenario>(folder / "b.yaml", {}), InputError);
}

TEST(LoadSettings, APresetSetsWhatIsNotSaidBesideIt) {
  const Lidar lidar = load("sensors: {lidar: {range_noise_m: 0.02, preset: utm30lx}}\n").sensors.lidar;
  EXPECT_EQ(lidar.preset, "utm30lx");
  EXPECT_EQ(lidar.beams, 1081);
  EXPECT_EQ(lidar.range_noise_m, 0.02);
}

TEST(LoadSettings, ExpectationsAreTruthsNumbersOrBands) {
  const Expectations expect =
      load("expect:\n  mission.completed: true\n  mission.collisions: 0\n  pose.ate_rmse_m: {max: 0.15}\n").expect;
  EXPECT_TRUE(expect.at("mission.completed").is_boolean);
  EXPECT_EQ(expect.at("mission.completed").min, 1.0);
  EXPECT_EQ(expect.at("mission.collisions").max, 0.0);
  EXPECT_EQ(expect.at("pose.ate_rmse_m").max, 0.15);
  EXPECT_EQ(expect.at("pose.ate_rmse_m").min, -std::numeric_limits<double>::infinity());
}

TEST(LoadSettings, UnknownKeyGivesFileLineAndNearestSpelling) {
  EXPECT_THAT(complaint_about("world: street\nsensors:\n  lidar: {range_nois_m: 0.03}\n"),
              StartsWith("a.yaml:3: sensors.lidar.range_nois_m: unknown key; did you mean range_noise_m?"));
  EXPECT_THAT(complaint_about("\n\nsede: 3\n"), StartsWith("a.yaml:3: sede: unknown key; did you mean seed?"));
  EXPECT_THAT(complaint_about("quaternion: 3\n"),
              StartsWith("a.yaml:1: quaternion: unknown key (known: world, seed, "));
}

TEST(LoadSettings, AWrongUnitIsAnUnknownKeyBesideTheRightOne) {
  EXPECT_THAT(complaint_about("sensors:\n  lidar:\n    range_noise_cm: 3\n"),
              StartsWith("a.yaml:3: sensors.lidar.range_noise_cm: unknown key; did you mean range_noise_m?"));
}

TEST(LoadSettings, AUnitBehindTheNumberIsNoNumber) {
  EXPECT_EQ(complaint_about("sensors:\n  lidar:\n    range_noise_m: 3cm\n"),
            "a.yaml:3: sensors.lidar.range_noise_m: must be a number, not 3cm");
}

TEST(LoadSettings, WrongTypesAreNamedWithWhatTheyMustBe) {
  EXPECT_EQ(complaint_about("seed: many\n"), "a.yaml:1: seed: must be a non-negative integer, not many");
  EXPECT_EQ(complaint_about("seed: -1\n"), "a.yaml:1: seed: must be a non-negative integer, not -1");
  EXPECT_EQ(complaint_about("seed: 1.5\n"), "a.yaml:1: seed: must be a non-negative integer, not 1.5");
  EXPECT_EQ(complaint_about("sensors: {lidar: {beams: 10.5}}\n"),
            "a.yaml:1: sensors.lidar.beams: must be an integer, not 10.5");
  EXPECT_EQ(complaint_about("sensors: {lidar: {enabled: 7}}\n"),
            "a.yaml:1: sensors.lidar.enabled: must be true or false");
  EXPECT_EQ(complaint_about("sensors: lidar\n"), "a.yaml:1: sensors: must be a section of keys and values");
  EXPECT_EQ(complaint_about("world: [a]\n"), "a.yaml:1: world: must be a string");
  EXPECT_EQ(complaint_about("leaks: 3\n"), "a.yaml:1: leaks: must be a list");
  EXPECT_EQ(complaint_about("wind_mps: [1, x]\n"), "a.yaml:1: wind_mps.1: must be a number, not x");
}

TEST(LoadSettings, NotANumberAndInfinityAreRefused) {
  EXPECT_EQ(complaint_about("sensors: {lidar: {range_noise_m: .nan}}\n"),
            "a.yaml:1: sensors.lidar.range_noise_m: must be a finite number, not .nan");
  EXPECT_EQ(complaint_about("sensors: {lidar: {range_noise_m: .inf}}\n"),
            "a.yaml:1: sensors.lidar.range_noise_m: must be a finite number, not .inf");
}

TEST(LoadSettings, OutOfRangeNamesTheRule) {
  EXPECT_EQ(complaint_about("sensors: {lidar: {range_noise_m: -1}}\n"),
            "a.yaml:1: sensors.lidar.range_noise_m: -1 is out of range: must be at least 0");
  EXPECT_EQ(complaint_about("wind_mps: [0, 51]\n"), "a.yaml:1: wind_mps.1: 51 is out of range: must be in [-50, 50]");
  EXPECT_EQ(complaint_about("sensors:\n  lidar:\n    preset: rplidar_s3\n"),
            "a.yaml:3: sensors.lidar.preset: rplidar_s3 is out of range: must be one of rplidar_s2, utm30lx");
  EXPECT_EQ(complaint_about("leaks:\n- {at: a, rate_g_s: 1}\n- {at: b, rate_g_s: -1}\n"),
            "a.yaml:3: leaks.1.rate_g_s: -1 is out of range: must be at least 0");
}

TEST(LoadSettings, ARepeatedKeyIsRefused) {
  EXPECT_EQ(complaint_about("seed: 1\nworld: street\nseed: 2\n"), "a.yaml:3: seed: duplicate key");
}

TEST(LoadSettings, TruncatedYamlNamesTheLine) {
  EXPECT_THAT(complaint_about("world: street\nsensors: {lidar: {range_noise_m: 0.0"),
              StartsWith("a.yaml:2: is not YAML: "));
  EXPECT_THAT(complaint_about("world: street\nsensors: \"lid"), StartsWith("a.yaml:2: is not YAML: "));
  EXPECT_THAT(complaint_about("- a\n- b\n"), StartsWith("a.yaml: must be a map of keys and values"));
}

TEST(LoadSettings, AMissingFileOrAFolderIsRefused) {
  const TemporaryFolder folder;
  EXPECT_THROW(load_settings<Scenario>(folder / "missing.yaml", {}), InputError);
  EXPECT_THROW(load_settings<Scenario>(folder.path(), {}), InputError);
}

TEST(LoadSettings, WrongExpectationsAreNamed) {
  EXPECT_EQ(complaint_about("expect:\n  pose.ate_rmse_m: good\n"),
            "a.yaml:2: expect.pose.ate_rmse_m: must be a number, not good");
  EXPECT_THAT(complaint_about("expect:\n  pose.ate_rmse_m: {maxi: 1}\n"),
              StartsWith("a.yaml:2: expect.pose.ate_rmse_m.maxi: unknown key; did you mean max?"));
}

TEST(LoadSettings, BoundsThatNoNumberOrEveryNumberMeetsAreRefused) {
  EXPECT_EQ(complaint_about("expect:\n  mission.distance_m: {min: 5, max: 3}\n"),
            "a.yaml:2: expect.mission.distance_m: min = 5 exceeds max = 3: must be at most max");
  EXPECT_EQ(complaint_about("expect:\n  mission.distance_m: {}\n"),
            "a.yaml:2: expect.mission.distance_m: must have min, max or both");
  EXPECT_EQ(load("expect: {mission.distance_m: {min: 3, max: 3}}\n").expect.at("mission.distance_m").min, 3.0);
}

TEST(LoadSettings, ASecondExpectationOfAMetricIsRefused) {
  EXPECT_EQ(complaint_about("expect:\n  pose.ate_rmse_m: {max: 1}\n  pose.ate_rmse_m: {max: 5}\n"),
            "a.yaml:3: expect.pose.ate_rmse_m: duplicate key");
  EXPECT_EQ(load("expect:\n  pose.ate_rmse_m: {max: 1}\n", {"expect.pose.ate_rmse_m={max: 5}"})
                .expect.at("pose.ate_rmse_m")
                .max,
            5.0);
}

TEST(Overrides, ReachSectionsAndListsAndMakeSections) {
  const Scenario scenario = load("leaks: [{at: a}, {at: b}]\n",
                                 {"leaks.1.rate_g_s=2.5", "sensors.lidar.beams=400", "seed=9", "wind_mps=[3, 4]"});
  EXPECT_EQ(scenario.leaks[1].rate_g_s, 2.5);
  EXPECT_EQ(scenario.sensors.lidar.beams, 400);
  EXPECT_EQ(scenario.seed, 9U);
  EXPECT_THAT(scenario.wind_mps, ElementsAre(3.0, 4.0));
}

TEST(Overrides, OfAnExpectationNameItsMetric) {
  const Scenario scenario = load("expect:\n  mission.completed: true\n  pose.ate_rmse_m: {max: 0.15}\n",
                                 {"expect.pose.ate_rmse_m={max: 0.2}", "expect.map.coverage={min: 0.5}"});
  EXPECT_EQ(scenario.expect.size(), 3U);
  EXPECT_EQ(scenario.expect.at("pose.ate_rmse_m").max, 0.2);
  EXPECT_EQ(scenario.expect.at("map.coverage").min, 0.5);
  EXPECT_EQ(load("{}", {"expect.mission.collisions=0"}).expect.at("mission.collisions").max, 0.0);
}

TEST(Overrides, WithBracketsAreRefusedWithTheNotationOfLists) {
  const TemporaryFile file("a.yaml", "leaks: [{at: a}]\n");
  EXPECT_THAT([&] { load_settings<Scenario>(file.path(), {"leaks[0].rate_g_s=5"}); },
              testing::ThrowsMessage<InputError>(
                  "--set leaks[0].rate_g_s=5: leaks[0].rate_g_s: must name entries of a list as in leaks.0"));
}

TEST(Overrides, AnUnknownSectionThatTheyMakeIsTheirs) {
  EXPECT_THAT(complaint_about("{}", {"sensor.lidar.beams=5"}),
              StartsWith("--set sensor.lidar.beams=5: sensor: unknown key; did you mean sensors?"));
}

TEST(Overrides, TheLastOfTwoWins) { EXPECT_EQ(load("seed: 1\n", {"seed=2", "seed=3"}).seed, 3U); }

TEST(Overrides, AreComplainedAboutLikeTheFile) {
  EXPECT_THAT(complaint_about("{}", {"sensors.lidar.range_nois_m=1"}),
              StartsWith("--set sensors.lidar.range_nois_m=1: unknown key; did you mean range_noise_m?"));
  EXPECT_EQ(complaint_about("seed: 1\n", {"seed=2", "seed=x"}), "--set seed=x: must be a non-negative integer, not x");
  EXPECT_THAT(complaint_about("seed: 1\n", {"leaks=[{rate_g_s: x}]"}),
              StartsWith("--set leaks=[{rate_g_s: x}]: leaks.0.rate_g_s: must be a number, not x"));
  EXPECT_THAT(complaint_about("seed: x\n", {"wind_mps=[3, 4]"}), StartsWith("a.yaml:1: seed: must be"));
  EXPECT_THAT(complaint_about("{}", {"seed"}), HasSubstr("--set seed: must be path=value"));
  EXPECT_THAT(complaint_about("leaks: [{at: a}]\n", {"leaks.1.at=b"}),
              HasSubstr("--set leaks.1.at=b: the list has 1 entries"));
  EXPECT_THAT(complaint_about("leaks: [{at: a}]\n", {"leaks.first.at=b"}), HasSubstr("must be a list index"));
  EXPECT_THAT(complaint_about("leaks: [{at: a}]\n", {"leaks.0x.at=b"}), HasSubstr("must be a list index"));
  EXPECT_THAT(complaint_about("seed: 1\n", {"seed.x=b"}), HasSubstr("is a child of a scalar"));
  EXPECT_EQ(complaint_about("seed: 1\n", {"leaks=[]x"}),
            "--set leaks=[]x: more than one YAML document: only one is allowed");
}

TEST(SaveSettings, WritesEveryDefaultAndReadsBackTheSame) {
  const TemporaryFolder folder;
  Scenario scenario = load(
      "leaks: [{at: a, rate_g_s: 0.1}]\nexpect: {mission.completed: true, pose.ate_rmse_m: {min: 0.01, max: "
      "0.15}}\n");
  scenario.sensors.lidar.range_noise_m = 0.1 + 0.2;  // needs all its digits
  scenario.world = "yes: it is [odd]";
  save_settings(folder / "a.yaml", scenario);
  EXPECT_THAT(read_bytes(folder / "a.yaml"), HasSubstr("beams: 1600"));
  const Scenario again = load_settings<Scenario>(folder / "a.yaml", {});
  EXPECT_EQ(again.sensors.lidar.range_noise_m, 0.1 + 0.2);
  EXPECT_EQ(again.world, scenario.world);
  EXPECT_EQ(again.leaks.at(0).rate_g_s, 0.1);
  EXPECT_TRUE(again.expect.at("mission.completed").is_boolean);
  EXPECT_EQ(again.expect.at("pose.ate_rmse_m").min, 0.01);
  save_settings(folder / "b.yaml", again);
  EXPECT_EQ(read_bytes(folder / "a.yaml"), read_bytes(folder / "b.yaml"));
}

TEST(SaveSettings, ACommentStandsAtTheHeadAndIsNotRead) {
  const TemporaryFolder folder;
  save_settings(folder / "a.yaml", load("{}\n"), "made by hand: [odd]\nseed: 7");
  EXPECT_THAT(read_bytes(folder / "a.yaml"), StartsWith("# made by hand: [odd]\n# seed: 7\n"));
  EXPECT_EQ(load_settings<Scenario>(folder / "a.yaml", {}).seed, 1U);
}

TEST(NearestWord, IsNearOrEmpty) {
  EXPECT_EQ(closest_match("partcles", {"particles", "paths"}), "particles");
  EXPECT_EQ(closest_match("xyz", {"particles", "paths"}), "");
  EXPECT_EQ(closest_match("", {}), "");
}

}  // namespace
}  // namespace patrol::io::settings_yaml_test
