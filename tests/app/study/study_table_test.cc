#include "app/study/study_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace patrol::app::study_table_test {
namespace {

using ::testing::HasSubstr;

TEST(StudyTable, AnUnknownOneIsRefusedWithTheKnownNames) {
  try {
    make_study("golf");
    FAIL();
  } catch (const std::exception& error) {
    EXPECT_THAT(error.what(), HasSubstr("unknown study 'golf' (known: ungm, landmarks-circle, "));
  }
}

TEST(StudyTable, EveryVariantsReferenceLiesInItsOwnWorld) {
  for (const std::string& name : study_names()) {
    const studies::Study study = make_study(name);
    for (const studies::StudyVariant& variant : study.variants)
      EXPECT_EQ(study.variants[variant.reference].world, variant.world) << name << ": " << variant.method;
  }
}

}  // namespace
}  // namespace patrol::app::study_table_test
