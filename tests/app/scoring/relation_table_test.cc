#include "app/scoring/relation_table.h"

#include <gtest/gtest.h>

namespace patrol::app::relation_table_test {
namespace {

TEST(RelationTable, HasTheFiguresInTheDigitsInWhichTheyArePublished) {
  const score::RelationError error{.num_relations = 2984,
                                   .num_given = 2990,
                                   .num_stamps = 3000,
                                   .num_interpolated = 7,
                                   .num_outside = 2,
                                   .num_in_holes = 1,
                                   .trans_m = {0.02291, 0.03514},
                                   .squared_trans_m2 = {0.00176, 0.01},
                                   .trans_median_m = 0.0151,
                                   .trans_max_m = 0.7654,
                                   .rot_deg = {0.4531, 1.2},
                                   .squared_rot_deg2 = {1.6452, 20.0},
                                   .rot_median_deg = 0.25,
                                   .rot_max_deg = 12.345};
  EXPECT_EQ(relation_table(error),
            "2984 of 2990 relations scored, 3000 stamps: 2990 nearest poses, 7 interpolated, 2 outside the estimate, "
            "1 in its holes\n"
            "\n"
            "                                 mean        std     median        max\n"
            "  translation, m               0.0229     0.0351     0.0151      0.765\n"
            "  translation squared, m2      0.0018     0.0100\n"
            "  rotation, deg                 0.453      1.200      0.250      12.35\n"
            "  rotation squared, deg2        1.645     20.000\n");
}

}  // namespace
}  // namespace patrol::app::relation_table_test
