#include "io/files/xml_problem.h"

#include <gtest/gtest.h>

namespace patrol::io::xml_problem_test {
namespace {

std::string problem_of(const char* text) {
  tinyxml2::XMLDocument document;
  document.Parse(text);
  return xml_problem(document);
}

TEST(XmlProblem, IsInWords) {
  EXPECT_EQ(problem_of(""), "empty document");
  EXPECT_EQ(problem_of("<a><b></a>"), "mismatched element: a tag is not closed");
  EXPECT_EQ(problem_of("<a b=>"), "parsing attribute");
}

}  // namespace
}  // namespace patrol::io::xml_problem_test
