#include "core/state/state_archive.h"

#include <cstdint>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/frames.h"
#include "core/state/message_state.h"

namespace patrol {
namespace {

enum class Phase : std::uint8_t { kWaiting, kDriving };

struct Padded {
  std::int8_t small = 0;
  double large = 0.0;
};

struct Part {
  Phase phase = Phase::kWaiting;
  std::optional<Pose2> pose;
  std::vector<Padded> padded;
  std::vector<bool> bits;
  std::map<int, std::string> names;
  std::variant<int, std::string, Pose3> kind;
  std::array<Eigen::Vector3d, 2> points{};
  Eigen::MatrixXd matrix;
  Grid<float> grid;
  std::deque<Time> times;
  std::pair<std::string, int> pair;
};

Part full_part() {
  Part part{.phase = Phase::kDriving,
            .pose = Pose2{1.0, 2.0, 3.0},
            .padded = {{1, 2.0}, {3, std::numeric_limits<double>::denorm_min()}},
            .bits = {true, false, true},
            .names = {{-1, "a"}, {7, std::string("b\0c", 3)}},
            .kind = std::string("text"),
            .points = {Eigen::Vector3d(1, 2, 3), Eigen::Vector3d(4, 5, 6)},
            .matrix = Eigen::MatrixXd::Identity(2, 3),
            .grid = Grid<float>({.resolution_m = 0.1, .width = 2, .height = 1}, 0.5F),
            .times = {Time{5}, Time{-6}},
            .pair = {"p", 4}};
  part.grid.at({1, 0}) = -0.0F;
  return part;
}

template <typename T>
std::string saved(T& object) {
  StateArchive archive;
  archive(object);
  return archive.bytes();
}

template <typename T>
void restore(const std::string& bytes, T& object) {
  StateArchive archive(bytes);
  archive(object);
  EXPECT_TRUE(archive.is_at_end());
}

TEST(StateArchive, EveryKindOfFieldReturnsWithItsBits) {
  Part part = full_part();
  Part other;
  restore(saved(part), other);
  EXPECT_EQ(other.phase, Phase::kDriving);
  ASSERT_TRUE(other.pose);
  EXPECT_EQ(other.pose->yaw, 3.0);
  ASSERT_EQ(other.padded.size(), 2U);
  EXPECT_EQ(other.padded[1].small, 3);
  EXPECT_EQ(other.padded[1].large, std::numeric_limits<double>::denorm_min());
  EXPECT_EQ(other.bits, part.bits);
  EXPECT_EQ(other.names, part.names);
  EXPECT_EQ(std::get<std::string>(other.kind), "text");
  EXPECT_EQ(other.points[1], Eigen::Vector3d(4, 5, 6));
  EXPECT_EQ(other.matrix, part.matrix);
  EXPECT_EQ(other.grid.geometry().width, 2);
  EXPECT_TRUE(std::signbit(other.grid.at({1, 0})));
  EXPECT_EQ(other.times, part.times);
  EXPECT_EQ(other.pair, part.pair);
  EXPECT_EQ(saved(other), saved(part));
}

TEST(StateArchive, ContainersThatWereFullBecomeEmpty) {
  Part empty, part = full_part();
  restore(saved(empty), part);
  EXPECT_FALSE(part.pose);
  EXPECT_TRUE(part.padded.empty());
  EXPECT_TRUE(part.names.empty());
  EXPECT_EQ(part.kind.index(), 0U);
  EXPECT_EQ(saved(part), saved(empty));
}

TEST(StateArchive, SharedObjectsStayShared) {
  const auto shared = std::make_shared<int>(5);
  std::vector<std::shared_ptr<int>> pointers = {shared, nullptr, shared, std::make_shared<int>(6)}, others;
  restore(saved(pointers), others);
  ASSERT_EQ(others.size(), 4U);
  EXPECT_EQ(others[0], others[2]);
  EXPECT_EQ(others[0].use_count(), 2);
  EXPECT_EQ(others[1], nullptr);
  EXPECT_EQ(*others[3], 6);
}

TEST(StateArchive, EveryMessageOfTheSensorsHasAState) {
  constexpr std::size_t kKinds = std::variant_size_v<SensorMessage>;
  std::vector<SensorMessage> messages, others;
  [&]<std::size_t... I>(std::index_sequence<I...>) { (messages.emplace_back(std::in_place_index<I>), ...); }
  (std::make_index_sequence<kKinds>{});
  restore(saved(messages), others);
  ASSERT_EQ(others.size(), kKinds);
  for (std::size_t i = 0; i < kKinds; ++i) EXPECT_EQ(others[i].index(), i);
}

TEST(StateArchive, TruncatedBytesAreRefused) {
  Part part = full_part();
  const std::string bytes = saved(part);
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    Part other;
    StateArchive archive(bytes.substr(0, size));
    EXPECT_THROW(archive(other), std::runtime_error) << size;
  }
}

TEST(StateArchive, AnotherSectionIsRefusedByName) {
  StateArchive saving;
  saving.section("first");
  StateArchive archive(saving.bytes());
  EXPECT_THAT([&] { archive.section("second"); },
              testing::ThrowsMessage<std::runtime_error>(testing::HasSubstr("'second' expected, 'first' found")));
}

TEST(StateArchive, PartsThatAppearOrVanishAreRefused) {
  std::vector<int> three = {1, 2, 3}, two = {1, 2};
  StateArchive saving;
  saving.in_place(three);
  StateArchive archive(saving.bytes());
  EXPECT_THROW(archive.in_place(two), std::runtime_error);

  std::optional<int> some = 1, none;
  StateArchive part;
  part.part(some);
  StateArchive other(part.bytes());
  EXPECT_THROW(other.part(none), std::runtime_error);
}

}  // namespace
}  // namespace patrol
