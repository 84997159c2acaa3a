#pragma once

#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "core/error.h"
#include "core/sensors/registry.h"
#include "tests/support/number_bytes.h"
#include "tests/support/temporary_file.h"

/// Point clouds and complaints, for the tests of PLY and PCD.
namespace patrol::io {

using test::bytes;

inline const std::vector<ScannerPoint> kThreePoints = {
    {1.5F, -2.25F, 0.125F, 200.0F}, {0.1F, 1e-7F, -70.0F, 0.0F}, {3e5F, -1.0F, 1.0F, 255.0F}};

inline void expect_same(const std::vector<ScannerPoint>& a, const std::vector<ScannerPoint>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].x, b[i].x) << i;
    EXPECT_EQ(a[i].y, b[i].y) << i;
    EXPECT_EQ(a[i].z, b[i].z) << i;
    EXPECT_EQ(a[i].intensity, b[i].intensity) << i;
  }
}

/// Error message of `load` for a file with this content, without its folder.
template <typename Load>
std::string complaint(const char* name, const std::string& content, Load load) {
  const test::TemporaryFolder folder;
  test::write_bytes(folder / name, content);
  try {
    load(folder / name);
  } catch (const InputError& error) {
    return std::string(error.what()).substr(folder.path().string().size() + 1);
  }
  return "accepted";
}

}  // namespace patrol::io
