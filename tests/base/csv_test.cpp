#include "base/csv.h"

#include "base/error.h"

namespace searchlight {
namespace {

std::string messageOf(std::string_view text) {
    try {
        parseCsv(text, "t.csv");
    } catch (const Error& error) {
        return error.what();
    }
    return "no error";
}

TEST(Csv, CellsKeepTheirPlaces) {
    const CsvTable table = parseCsv("# a sentence: no key\nr , value\n\n 0.5,\"a, \"\"b\"\" \"\n1e3,\n", "t.csv");
    ASSERT_EQ(table.rows.size(), 2u);
    EXPECT_EQ(table.header[1].text, "value");
    EXPECT_EQ(table.header[1].column, 5);
    EXPECT_EQ(table.rows[0][0].text, "0.5");
    EXPECT_EQ(table.rows[0][0].line, 4);
    EXPECT_EQ(table.rows[0][0].column, 2);
    EXPECT_EQ(table.rows[0][1].text, "a, \"b\" ");
    EXPECT_EQ(table.rows[1][1].text, "");
    EXPECT_EQ(table.number(1, 0), 1000);
    EXPECT_EQ(table.find("value"), 1u);
    EXPECT_EQ(table.find("Value"), std::nullopt);
}

TEST(Csv, MetadataIsAKeyInSnakeCase) {
    const CsvTable table =
        parseCsv("# unit: 1/mm\n# Columns: r and R_d\n#per_flux:transmitted: yes\nr\n# note: late\n", "t.csv");
    EXPECT_EQ(table.meta("unit"), "1/mm");
    EXPECT_EQ(table.meta("per_flux"), "transmitted: yes");
    EXPECT_EQ(table.meta("note"), "late");
    EXPECT_EQ(table.meta("columns"), "");
    EXPECT_EQ(table.metadata.size(), 3u);
}

TEST(Csv, ByteOrderMarkAndCarriageReturnsAreNotText) {
    const CsvTable table = parseCsv("\xEF\xBB\xBFid,eta\r\nwax,1.4\r\n", "t.csv");
    EXPECT_EQ(table.header[0].text, "id");
    EXPECT_EQ(table.number(0, 1), 1.4);
}

TEST(Csv, FaultsNameLineAndColumn) {
    EXPECT_EQ(messageOf(""), "t.csv: no header row (the first line names the columns)");
    EXPECT_EQ(messageOf("# only: this\n"), "t.csv: no header row (the first line names the columns)");
    EXPECT_EQ(messageOf("# a: 1\n#  a: 2\nr\n"), "t.csv:2:4: 'a' is given twice");
    EXPECT_EQ(messageOf("r,,v\n"), "t.csv:1:3: column without a name");
    EXPECT_EQ(messageOf("r,v,r\n"), "t.csv:1:5: column 'r' stands twice");
    EXPECT_EQ(messageOf("r,v\n1\n"), "t.csv:2:1: 1 fields, expected 2 (as in the header on line 1)");
    EXPECT_EQ(messageOf("r,v\n1,2,3\n"), "t.csv:2:5: 3 fields, expected 2 (as in the header on line 1)");
    EXPECT_EQ(messageOf("r,v\n1, \"2\n"), "t.csv:2:4: quoted field does not end on its line (close it with \")");
    EXPECT_EQ(messageOf("r,v\n\"1\" x,2\n"),
              "t.csv:2:5: text after the closing quote (expected a comma or the end of the line)");
    EXPECT_EQ(messageOf(std::string_view("r\n\0\n", 4)), "t.csv:2:1: NUL byte (expected text)");
}

TEST(Csv, CellThatIsNoFiniteNumberIsNamed) {
    const CsvTable table = parseCsv("r,v\n1,nan\n", "t.csv");
    EXPECT_EQ(table.number(0, 0), 1);
    try {
        table.number(0, 1);
        FAIL() << "nan was read as a number";
    } catch (const Error& error) {
        EXPECT_STREQ(error.what(), "t.csv:2:3: 'nan' is no value for v (expected a finite number)");
    }
}

}  // namespace
}  // namespace searchlight
