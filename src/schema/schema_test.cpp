// SPDX-License-Identifier: Apache-2.0
#include "schema/table.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "schema/toml.h"

namespace gischt {
namespace {

struct Dummy {
    double a = 1;
    Keyed<Vec3d> v;
};
TEST(Table, Reads) {
    static const Table<Dummy> t =
        Table<Dummy>("dummy", "x").add("a", &Dummy::a, {.unit = "m", .min = 0}).add("v", &Dummy::v);
    EXPECT_EQ(read(parse_toml("a = 4", "x"), t).a, 4);
    EXPECT_THROW(read(parse_toml("a = -4", "x"), t), Error);
}

}  // namespace
}  // namespace gischt
