#include "app/campaign/batch/batch_options.h"

#include <gtest/gtest.h>

#include "core/error.h"

namespace patrol::app::batch_options_test {
namespace {

TEST(BatchOptions, NoNumberOfJobsIsOneForEachCore) {
  EXPECT_GE(batch_settings({}).pool.num_processes, 1);
  EXPECT_EQ(batch_settings({.jobs = 3}).pool.num_processes, 3);
}

TEST(BatchOptions, WhatCannotBeIsRefused) {
  EXPECT_THROW(batch_settings({.jobs = -1}), InputError);
  EXPECT_THROW(batch_settings({.jobs = 2000}), InputError);
  EXPECT_THROW(batch_settings({.run_timeout_s = 0.0}), InputError);
  EXPECT_THROW(batch_settings({.keep = "some"}), InputError);
}

}  // namespace
}  // namespace patrol::app::batch_options_test
