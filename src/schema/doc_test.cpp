// SPDX-License-Identifier: Apache-2.0
#include "schema/doc.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "schema/test_scene.h"

namespace gischt::test {
namespace {

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

TEST(Doc, EveryKeyOfEveryComponentIsInTheManual) {
    const std::string page = markdown(scene_table());
    for (const Component* c : all_components(scene_table())) {
        EXPECT_TRUE(contains(page, "## " + c->name + "\n"));
        for (const Parameter& p : c->parameters) {
            EXPECT_TRUE(contains(page, "| `" + p.key + "` |")) << p.key;
            EXPECT_TRUE(contains(document(*c), "  " + p.key)) << p.key;
        }
    }
}

TEST(Doc, AKeyShowsTypeUnitDefaultRangeAndWords) {
    EXPECT_EQ(document(scene_table(), "domain.size"),
              "  size  3 numbers, m, default [1.0, 1.0, 2.0], above 0\n        Edges\n");
    EXPECT_EQ(document(scene_table(), "fluid.advection"),
              "  advection  word, default \"maccormack\"\n"
              "               semi_lagrangian  smooth\n"
              "               maccormack       sharp\n");
}

TEST(Doc, AddressesAreComponentsKeysOrPaths) {
    EXPECT_EQ(document(scene_table(), "fluid.domain.resolution"),
              document(scene_table(), "domain.resolution"));
    EXPECT_EQ(document(scene_table(), "light.angle"), document(scene_table(), "sun.angle"));
    EXPECT_TRUE(contains(document(scene_table(), "light"), "point  A small bulb"));
    EXPECT_TRUE(contains(document(scene_table(), ""), "medium"));
    EXPECT_EQ(message_of([] { document(scene_table(), "medum"); }),
              "no component or key 'medum'; did you mean 'medium'?");
    EXPECT_EQ(message_of([] { document(scene_table(), "medium.gg"); }),
              "no key 'gg' in [medium]; did you mean 'g'?");
    EXPECT_EQ(message_of([] { document(scene_table(), "medium.g.x"); }), "'g' has no keys");
}

TEST(Doc, LinesFitATerminal) {
    struct Wordy {
        double x = 0;
    };
    std::string help;
    for (int i = 0; i < 100; ++i) help += "word ";
    const Table<Wordy> table = Table<Wordy>("wordy", "").add("x", &Wordy::x, {.help = help});
    std::istringstream lines(document(table));
    for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 100u);
}

TEST(Doc, MarkdownCellsKeepTheirBars) {
    EXPECT_TRUE(contains(markdown(scene_table()), "Mean cosine \\| of scattering"));
}

TEST(Doc, JsonSchemaDescribesEveryKey) {
    const nlohmann::json schema = nlohmann::json::parse(json_schema(scene_table()));
    EXPECT_EQ(schema["$ref"], "#/$defs/scene");
    const nlohmann::json& defs = schema["$defs"];
    const nlohmann::json& domain = defs["domain"]["properties"];
    EXPECT_EQ(domain["resolution"]["type"], "integer");
    EXPECT_EQ(domain["resolution"]["minimum"], 1);
    EXPECT_EQ(domain["resolution"]["default"], 64);
    EXPECT_EQ(domain["size"]["items"]["exclusiveMinimum"], 0);
    EXPECT_EQ(domain["size"]["minItems"], 3);
    EXPECT_EQ(domain["size"]["maxItems"], 3);
    const nlohmann::json& fluid = defs["fluid_element"]["properties"];
    EXPECT_EQ(fluid["advection"]["enum"], nlohmann::json({"semi_lagrangian", "maccormack"}));
    EXPECT_EQ(fluid["buoyancy"]["anyOf"][1]["required"], nlohmann::json({"t", "v"}));
    EXPECT_EQ(fluid["domain"]["$ref"], "#/$defs/domain");
    EXPECT_FALSE(fluid["time_step"].contains("default"));
    EXPECT_EQ(defs["camera"]["required"], nlohmann::json({"position"}));
    EXPECT_EQ(defs["light_element"]["anyOf"].size(), 2u);
    EXPECT_EQ(defs["light_element"]["anyOf"][0]["properties"]["type"]["const"], "sun");
    EXPECT_EQ(defs["light_element"]["anyOf"][0]["properties"]["name"]["type"], "string");
    EXPECT_FALSE(defs["light"]["anyOf"][0]["properties"].contains("name"));
}

}  // namespace
}  // namespace gischt::test
