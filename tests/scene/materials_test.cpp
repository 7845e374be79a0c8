#include "scene/materials.h"

#include <unistd.h>

#include <filesystem>
#include <map>
#include <set>

#include "base/csv.h"
#include "base/error.h"
#include "base/files.h"
#include "base/text.h"

namespace searchlight {
namespace {

namespace fs = std::filesystem;

std::string messageOf(std::string_view id) {
    try {
        findMaterial(id);
    } catch (const Error& error) {
        return error.what();
    }
    return "no error";
}

TEST(Materials, EveryTableIsThereWithAllItsRows) {
    std::map<std::string, int> rows;
    for (const Material& material : materials()) ++rows[material.source];
    EXPECT_EQ(rows, (std::map<std::string, int>{{"gkioulekas2013", 4}, {"jensen2001", 12}, {"narasimhan2006", 35}}));
}

TEST(Materials, IdsAreUniqueAndEveryMaterialIsFoundByItsOwnAndItsQualifiedId) {
    std::set<std::string> ids;
    for (const Material& material : materials()) {
        EXPECT_TRUE(ids.insert(material.id).second) << material.id;
        EXPECT_EQ(findMaterial(material.id).id, material.id);
        const std::string short_id = material.id.substr(material.id.rfind(':') + 1);
        EXPECT_EQ(short_id, lowerSnake(short_id));
        EXPECT_EQ(findMaterial(material.source + ":" + short_id).id, material.id);
        for (const std::string& alias : material.aliases) EXPECT_EQ(findMaterial(alias).id, material.id);
        EXPECT_FALSE(material.name.empty());
        EXPECT_FALSE(material.citation.empty());
    }
}

TEST(Materials, Skin1IsWhatTheTablePrints) {
    const Material skin = findMaterial("skin1");
    EXPECT_EQ(skin.medium.sigma_s, (Rgb{0.74, 0.88, 1.01}));
    EXPECT_EQ(skin.medium.sigma_a, (Rgb{0.032, 0.17, 0.48}));
    EXPECT_EQ(skin.medium.g, Rgb{});
    EXPECT_EQ(skin.medium.eta, 1.3);
    EXPECT_EQ(skin.published_Rd, (Rgb{0.44, 0.22, 0.13}));
    EXPECT_EQ(skin.source, "jensen2001");
    EXPECT_TRUE(skin.reduced);
    EXPECT_EQ(skin.note, "published reduced: taken as sigma_s' with g = 0");
}

TEST(Materials, MilkIsFoundAsThePaperSpellsIt) {
    EXPECT_EQ(findMaterial("skimmilk").id, "skim_milk");
    EXPECT_EQ(findMaterial("skim_milk").name, "Skimmilk");
    EXPECT_EQ(findMaterial("wholemilk").id, "whole_milk");
}

TEST(Materials, DoubtAboutARowStandsBesideTheNoteOfItsTable) {
    EXPECT_THAT(findMaterial("chicken1").note, testing::HasSubstr("; printed blue reflectance 0.10 does not follow"));
}

TEST(Materials, ChannelsWithoutMeasuredScatteringAreSaid) {
    const Material merlot = findMaterial("merlot");
    EXPECT_TRUE(merlot.medium.scatters(0));
    EXPECT_FALSE(merlot.medium.scatters(1));
    EXPECT_FALSE(merlot.medium.scatters(2));
    EXPECT_THAT(merlot.note, testing::EndsWith("; no scattering measured in green and blue"));
    for (const Material& material : materials())
        for (int c = 0; c < 3; ++c)
            EXPECT_TRUE(material.medium.scatters(c) || material.note.find("no scattering") != std::string::npos)
                << material.id;
}

TEST(Materials, TableWithoutUnitIsMarkedAndStandsLast) {
    bool known = true;
    for (const Material& material : materials()) {
        EXPECT_EQ(material.unit_known, material.source != "gkioulekas2013") << material.id;
        EXPECT_FALSE(!known && material.unit_known) << material.id;
        known = material.unit_known;
    }
}

TEST(Materials, IdOfTwoTablesIsRefusedWithBoth) {
    EXPECT_EQ(messageOf("shampoo"),
              "'shampoo' names 2 materials (write narasimhan2006:shampoo or gkioulekas2013:shampoo)");
    EXPECT_EQ(findMaterial("narasimhan2006:shampoo").medium.sigma_s.r, 0.00797336);
    EXPECT_EQ(findMaterial("gkioulekas2013:shampoo").medium.sigma_s.r, 8.111);
}

TEST(Materials, UnknownIdIsAnsweredWithTheNearest) {
    EXPECT_EQ(messageOf("skin3"), "unknown material 'skin3' (did you mean: skin1, skin2, sprite)");
    EXPECT_EQ(
        messageOf("jensen2001:merlot"),
        "unknown material 'jensen2001:merlot' (did you mean: jensen2001:marble, jensen2001:apple, jensen2001:cream)");
    EXPECT_EQ(messageOf(""), "unknown material '' (did you mean: coke, apple, cream)");
}

class MaterialFile : public testing::Test {
protected:
    std::string write(std::string_view text) {
        writeFile(path_, text);
        return path_.string();
    }
    void TearDown() override { fs::remove(path_); }

    fs::path path_ = fs::temp_directory_path() / ("searchlight_" + std::to_string(getpid()) + ".csv");
};

TEST_F(MaterialFile, RowIsFoundByPathAndId) {
    const std::string path =
        write("# citation: my bench\r\n# unit: 1/cm\r\nid,eta,sigma_a,sigma_s,g\r\nwax,1.4,0.5,20,0.8\r\n");
    const Material wax = findMaterial(path + ":wax");
    EXPECT_DOUBLE_EQ(wax.medium.sigma_a.r, 0.05);
    EXPECT_DOUBLE_EQ(wax.medium.sigma_s.g, 2);
    EXPECT_EQ(wax.medium.channels, 1);
    EXPECT_EQ(wax.medium.g.b, 0.8);
    EXPECT_EQ(wax.name, "wax");
    EXPECT_FALSE(wax.reduced);
    EXPECT_EQ(findMaterial(path).id, "wax");
    EXPECT_EQ(messageOf(path + ":max"), "unknown material in " + path + " 'max' (valid: wax)");
}

TEST_F(MaterialFile, PathAloneNeedsATableOfOneRow) {
    const std::string path = write("# citation: me\n# unit: 1/mm\nid,eta,sigma_a,sigma_s\na,1,1,1\nb,1,1,1\n");
    EXPECT_EQ(messageOf(path), path + " has 2 materials (write " + path + ":ID)");
}

TEST(Materials, MissingFileIsNamed) { EXPECT_EQ(messageOf("no/such.csv:wax"), "no/such.csv: no such file"); }

// The embedded tables against the collected ones, which also say what the dipole makes of each row.
TEST(Materials, NumbersAreThoseOfTheCollectedTables) {
    const fs::path shared = fs::path(SEARCHLIGHT_SOURCE_DIR) / "../shared/data/optics";
    if (!fs::exists(shared)) GTEST_SKIP() << "the collected tables (../shared/data/optics) are not here";
    for (const auto& [source, file] :
         {std::pair{"jensen2001", "jensen2001.csv"}, {"narasimhan2006", "narasimhan2006.csv"}}) {
        const CsvTable table = parseCsv(readFile(shared / file), file);
        std::vector<const Material*> rows;
        for (const Material& material : materials())
            if (material.source == source) rows.push_back(&material);
        ASSERT_EQ(rows.size(), table.rows.size());
        for (std::size_t row = 0; row < rows.size(); ++row) {
            const Medium& medium = rows[row]->medium;
            EXPECT_EQ(rows[row]->name, table.rows[row][0].text);
            EXPECT_EQ(medium.eta, table.number(row, *table.find("eta")));
            for (int c = 0; c < 3; ++c) {
                const auto cell = [&](const std::string& quantity) {
                    return table.number(row, *table.find(quantity + "_" + "RGB"[c]));
                };
                EXPECT_EQ(medium.sigma_a[c], cell("sigma_a")) << rows[row]->id;
                EXPECT_EQ(medium.sigma_s[c], cell(rows[row]->reduced ? "sigma_sp" : "sigma_s")) << rows[row]->id;
                if (rows[row]->reduced) {
                    EXPECT_EQ(rows[row]->published_Rd[c], cell("Rd")) << rows[row]->id;
                } else {
                    EXPECT_EQ(medium.g[c], cell("g")) << rows[row]->id;
                }
            }
        }
    }
}

}  // namespace
}  // namespace searchlight
