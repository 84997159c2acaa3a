#include "core/event.h"

#include <set>

#include <gtest/gtest.h>

#include "core/settings.h"

namespace patrol::event_test {
namespace {

TEST(EventKinds, HaveUniqueNamesAndASummary) {
  std::set<std::string_view> names;
  for (const EventKindRow& row : kEventKinds) {
    EXPECT_TRUE(names.insert(row.name).second) << row.name;
    EXPECT_FALSE(row.summary.empty()) << row.name;
    EXPECT_EQ(event_kind_named(row.name), row.value) << row.name;
  }
}

TEST(EventKinds, OfFindingsFollowTheirLevel) {
  EXPECT_EQ(name_of(lining_event(WarningLevel::kWarning)), "lining_warning");
  EXPECT_EQ(name_of(water_event(WarningLevel::kNotice)), "water_notice");
  EXPECT_EQ(level_of(water_event(WarningLevel::kAlarm)), WarningLevel::kAlarm);
}

TEST(EventKinds, FailuresAreHazardsFailedTasksAndFaults) {
  for (const EventKind kind : {EventKind::kGasAlarm, EventKind::kGoalFailed, EventKind::kLocalizationLost})
    EXPECT_TRUE(is_failure(kind));
  for (const EventKind kind : {EventKind::kGoalReached, EventKind::kRecovery, EventKind::kForeign})
    EXPECT_FALSE(is_failure(kind));
}

TEST(Event, KeepsTheTextOfAForeignKind) {
  Event event;
  set_kind(event, "elevator_called");
  EXPECT_EQ(event.kind, EventKind::kForeign);
  EXPECT_EQ(kind_text(event), "elevator_called");
  set_kind(event, "fall");
  EXPECT_EQ(event.kind, EventKind::kFall);
  EXPECT_EQ(kind_text(event), "fall");
}

enum class Color { kRed, kGreen };
constexpr std::array<NamedValue<Color>, 2> kColors = {{{Color::kRed, "red", "Warm"}, {Color::kGreen, "green", "Cold"}}};

TEST(NamedTable, FindsByNameAndListsWhatIsAllowed) {
  EXPECT_EQ(row_named(kColors, "green", "paint.color").value, Color::kGreen);
  EXPECT_EQ(find_named(kColors, "blue"), nullptr);
  EXPECT_EQ(one_of(kColors).allowed, (std::vector<std::string>{"red", "green"}));
  try {
    row_named(kColors, "blue", "paint.color");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "paint.color = blue: must be one of red, green");
  }
}

}  // namespace
}  // namespace patrol::event_test
