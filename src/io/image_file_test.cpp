// SPDX-License-Identifier: Apache-2.0
#include "io/image_file.h"

#include <gtest/gtest.h>

#include "io/test_files.h"

namespace gischt {
namespace {

TEST(ImageFile, ChoosesTheFormatByExtension) {
    const TestFolder folder("image");
    const Image image = random_image(16, 16);
    for (const char* name : {"a.exr", "b.PNG", "c.hdr"}) {
        EXPECT_TRUE(is_image_file(name));
        write_image(folder.file(name), image);
        const Image back = read_image(folder.file(name));
        EXPECT_EQ(back.width, 16);
        EXPECT_TRUE(back.has("R"));
    }
    EXPECT_EQ(read_image(folder.file("b.PNG")).metadata.get("tone"), "filmic");
}

TEST(ImageFile, ListsTheExtensionsWhenItKnowsNone) {
    try {
        read_image("picture.jpeg");
        FAIL();
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::Usage);
        EXPECT_EQ(e.hint(), "valid: .exr, .png, .hdr");
    }
    EXPECT_EQ(outcome([] { write_image("picture", Image::rgb(1, 1)); }), Outcome::Usage);
    EXPECT_EQ(outcome([] {
                  write_image("a.png", Image::rgb(1, 1), {.display = {}, .bits = 7, .exr = {}});
              }),
              Outcome::Usage);
}

}  // namespace
}  // namespace gischt
