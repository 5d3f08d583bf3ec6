// SPDX-License-Identifier: BSD-3-Clause
#include "base/parser_fault.h"

#include <gtest/gtest.h>

namespace spherule::internal {
namespace {

TEST(XmlMarkup, TagsEndBehindTheirValues) {
  EXPECT_EQ(end_of_tag("<a b='>'/>c", 0), 10U);
  EXPECT_EQ(end_of_tag("x<a b=\"'>\">c", 1), 11U);
  EXPECT_EQ(end_of_tag("<a b='>", 0), 7U) << "does not end";
}

TEST(XmlMarkup, OtherMarkupEndsWhereItsKindDoes) {
  EXPECT_EQ(end_of_other_markup("<!-- <a> --><b/>", 0), 12U);
  EXPECT_EQ(end_of_other_markup("<![CDATA[>]]><b/>", 0), 13U);
  EXPECT_EQ(end_of_other_markup("<?a > ?><b/>", 0), 8U);
  EXPECT_EQ(end_of_other_markup("<!-- <a>", 0), 8U) << "does not end";
  EXPECT_EQ(end_of_other_markup("c<b/>", 1), 1U) << "is a tag";
}

}  // namespace
}  // namespace spherule::internal
