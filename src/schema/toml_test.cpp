// SPDX-License-Identifier: Apache-2.0
#include "schema/toml.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "base/random.h"
#include "schema/test_scene.h"

namespace gischt::test {
namespace {

std::string repeated(const std::string& text, int count) {
    std::string out;
    for (int i = 0; i < count; ++i) out += text;
    return out;
}

TEST(Toml, KeepsTheOrderOfKeysAndTheirPlaces) {
    const Value v = parse_toml("z = 1\na = [2,\n  3]\n[m]\nb.c = true\n", "f");
    ASSERT_EQ(v.members().size(), 3u);
    EXPECT_EQ(v.members()[0].key, "z");
    EXPECT_EQ(v.members()[1].key, "a");
    EXPECT_EQ(v.find("a")->array()[1].at.text(), "f:3:3");
    EXPECT_EQ(v.find("m")->at.text(), "f:4:1");
    EXPECT_EQ(v.find("m")->find("b")->member("c")->key_at.text(), "f:5:3");
}

TEST(Toml, BadSyntaxSaysWhere) {
    EXPECT_EQ(message_of([] { parse_toml("a = 1\nb = = 2\n", "f.toml"); }).rfind("f.toml:2:", 0),
              0u);
    EXPECT_EQ(message_of([] { parse_toml("a = 1\na = 2\n", "f.toml"); }).rfind("f.toml:2:", 0), 0u);
    EXPECT_EQ(message_of([] { parse_toml("a = 1\n[b]\nc = 2020-01-01\n", "f.toml"); }),
              "f.toml:3:5: dates and times have no use here");
}

TEST(Toml, NothingAndCommentsAreAnEmptyTable) {
    EXPECT_EQ(parse_toml("", "f"), Value());
    EXPECT_EQ(parse_toml("\xef\xbb\xbf# only a remark\r\n", "f"), Value());
}

TEST(Toml, GarbageIsRefusedAndNeverACrash) {
    for (std::uint32_t i = 0; i < 2000; ++i) {
        std::string text =
            i % 2 ? "[[a]]\nb = [1, 2]\nc = \"x\"\nd = { t = [0], v = [1.5] }\n" : "";
        const std::size_t size = text.empty() ? 64 : text.size();
        text.resize(size);
        for (std::uint32_t k = 0; k < 8; ++k) {
            text[random_bits(random_key(i), 2 * k) % size] =
                static_cast<char>(random_bits(random_key(i), 2 * k + 1));
        }
        message_of([&] {
            EXPECT_EQ(parse_toml(to_toml(parse_toml(text, "f")), "g").kind(), Value::Kind::Table);
        });
    }
}

TEST(Toml, DeepNestingIsRefused) {
    const auto error_of = [](const std::string& text) {
        return message_of([&] { parse_toml(text, "f"); });
    };
    for (const int depth : {200, 100000}) {
        const std::string open = repeated("[", depth), close = repeated("]", depth);
        const std::string words = repeated(".a", depth);
        EXPECT_NE(error_of(fmt::format("a = {}", open)), "");
        EXPECT_NE(error_of(fmt::format("a = {}{}", open, close)), "");
        EXPECT_NE(error_of(fmt::format("a = {}", repeated("{a=", depth))), "");
        EXPECT_NE(error_of(fmt::format("a{} = 1", words)), "");
        EXPECT_NE(error_of(fmt::format("[a{}]", words)), "");
    }
    const std::string level = fmt::format("[{{a{} = ", repeated(".a", 99));
    EXPECT_NE(error_of(fmt::format("a = {}", repeated(level, 120))), "");
    EXPECT_NE(error_of(fmt::format("a = {}1{}", repeated(level, 120), repeated("}]", 120))), "");
    EXPECT_EQ(error_of(fmt::format("a = '{}'", repeated(".", 500))), "");
    EXPECT_EQ(error_of(fmt::format("a = {}{}", repeated("[", 50), repeated("]", 50))), "");
}

TEST(Toml, WriterRoundTrips) {
    const std::string text =
        "a = 1\n"
        "b = 0.1\n"
        "c = [1.0, -2.0, 1e-07]\n"
        "d = { t = [0, 1], v = [[1, 2], []], interpolation = \"step\" }\n"
        "\"odd key\" = \"\\u0001 \\\\ \\\" \xc3\xa4\"\n"
        "e = [{ x = 1 }, 2]\n"
        "empty = []\n"
        "\n[s]\nx = true\n"
        "\n[s.sub]\ny = 1e+20\n"
        "\n[[list]]\nname = \"p\"\n"
        "\n[list.in]\nz = -9223372036854775807\n"
        "\n[[list]]\n";
    const Value v = parse_toml(text, "f");
    EXPECT_EQ(to_toml(v), text);
    EXPECT_EQ(parse_toml(to_toml(v), "g"), v);
}

TEST(Toml, AFileThatIsNotThereIsABadScene) {
    const std::string path = testing::TempDir() + "gischt_schema_toml_test.toml";
    std::filesystem::remove(path);
    EXPECT_EQ(message_of([&] { read_toml(path); }).rfind(path + ": cannot be opened", 0), 0u);
    EXPECT_NE(message_of([] { read_toml(testing::TempDir()); }), "");
    std::ofstream(path) << "a = 5\n";
    EXPECT_EQ(read_toml(path).find("a")->at.text(), path + ":1:5");
    std::filesystem::remove(path);
}

}  // namespace
}  // namespace gischt::test
