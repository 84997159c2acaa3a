#include "stack/instruments/instrument_set.h"

#include <gtest/gtest.h>

namespace patrol::stack::instrument_set_test {
namespace {

/// Finishes an order in its third step, and raises an alarm then.
class CountingInstrument final : public Instrument {
 public:
  explicit CountingInstrument(std::vector<std::string>& log) : log_(log) {}

  InstrumentKind kind() const override { return InstrumentKind::kWater; }
  void add(const SensorMessage&, const StationPoseLookup&) override { log_.push_back("message"); }
  void begin(const InspectionOrder& order, Time) override {
    steps_ = 0;
    log_.push_back("begin " + order.station);
  }
  InspectionProgress step(const InspectionContext& context) override {
    if (++steps_ < 3) return {};
    context.light.warn(context.now, WarningLevel::kAlarm, context.output);
    return {.feedback = InspectionFeedback::kDone};
  }
  void end() override { log_.push_back("end"); }
  void serialize_state(StateArchive&) override {}

 private:
  std::vector<std::string>& log_;
  int steps_ = 0;
};

class InstrumentSetTest : public ::testing::Test {
 protected:
  InspectionFeedback step(double time_s, const std::optional<InspectionOrder>& order) {
    return set_.step(from_seconds(time_s), order, {}, output_).feedback;
  }

  std::vector<std::string> log_;
  InstrumentSet set_ = [this] {
    std::vector<std::unique_ptr<Instrument>> instruments;
    instruments.push_back(std::make_unique<CountingInstrument>(log_));
    return InstrumentSet(std::move(instruments), 2.0);
  }();
  StackOutput output_;
};

const InspectionOrder kFirst{.instrument = InstrumentKind::kWater, .station = "first"};

TEST_F(InstrumentSetTest, CarriesOutAnOrderAndBeginsAnewWithTheNext) {
  EXPECT_EQ(step(0.0, kFirst), InspectionFeedback::kInProgress);
  EXPECT_EQ(step(0.1, kFirst), InspectionFeedback::kInProgress);
  EXPECT_EQ(step(0.2, kFirst), InspectionFeedback::kDone);
  EXPECT_EQ(step(0.3, std::nullopt), InspectionFeedback::kInProgress);
  InspectionOrder second = kFirst;
  second.station = "second";
  EXPECT_EQ(step(0.4, second), InspectionFeedback::kInProgress);
  EXPECT_EQ(log_, (std::vector<std::string>{"begin first", "end", "begin second"}));
}

TEST_F(InstrumentSetTest, AnOrderForAnInstrumentThatIsNotThereFails) {
  EXPECT_EQ(step(0.0, InspectionOrder{.instrument = InstrumentKind::kLining, .station = "first"}),
            InspectionFeedback::kFailed);
  EXPECT_TRUE(log_.empty());
}

TEST_F(InstrumentSetTest, TheSirenSoundsForItsTimeAndTheLightStaysOn) {
  for (const double time_s : {0.0, 0.1, 0.2}) step(time_s, kFirst);
  for (const double time_s : {1.0, 2.1, 2.3, 2.4}) step(time_s, std::nullopt);
  const std::vector<StackMessage> messages = output_.take_messages();
  ASSERT_EQ(messages.size(), 2U);
  const auto on = std::get<WarningCommand>(messages[0]), later = std::get<WarningCommand>(messages[1]);
  EXPECT_TRUE(on.light && on.siren);
  EXPECT_EQ(on.stamp, from_seconds(0.2));
  EXPECT_TRUE(later.light && !later.siren);
  EXPECT_EQ(later.stamp, from_seconds(2.3));
}

}  // namespace
}  // namespace patrol::stack::instrument_set_test
