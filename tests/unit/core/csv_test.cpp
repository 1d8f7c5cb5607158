// Tables of spreadsheets are read alike with every separator; lines keep their numbers; written tables are read back.
#include "gateway/core/csv.hpp"

#include <gtest/gtest.h>

#include <array>
#include <utility>

#include "gateway/core/text.hpp"

namespace axisgate {
namespace {
using Cells = std::vector<std::string>;

constexpr std::array<CsvColumn, 3> pears{{{"name"}, {"weight", true}, {"from"}}};
constexpr CsvShape pear_shape{pears, 3, "pears", "name,weight"};

struct Table {
    explicit Table(std::string_view text, const CsvShape& shape = pear_shape) : rows(rows_from_csv(text, shape, lines, faults)) {}
    std::vector<std::size_t> lines;
    std::vector<CsvFault> faults;
    std::optional<boost::json::array> rows;
};

TEST(Csv, EverySeparatorAndMarkOfASpreadsheet) {
    for (const auto* text : {"name,weight,from\r\nConference,0.25,here\r\n", "name;weight;from\nConference;0,25;here",
                             "name\tweight\tfrom\nConference\t0,25\there\n", "\xEF\xBB\xBFname;weight;from\r\nConference;0.25;here\r\n",
                             "\r\n\nname\tweight\tfrom\nConference\t0.25\there\n"}) {
        const Table t(text);
        ASSERT_TRUE(t.rows && t.faults.empty()) << text << (t.faults.empty() ? "" : t.faults[0].text);
        ASSERT_EQ(t.rows->size(), 1u) << text;
        EXPECT_EQ(t.rows->at(0), (boost::json::object{{"name", "Conference"}, {"weight", 0.25}, {"from", "here"}})) << text;
    }
    const Table comma("name\tfrom\nConference, large\tleft; right\n");
    ASSERT_TRUE(comma.rows && comma.faults.empty());
    EXPECT_EQ(comma.rows->at(0).at("name"), "Conference, large");
    const Table one("name\nConference\n");
    EXPECT_TRUE(one.rows && one.rows->size() == 1) << "a table of one column has no separator";
}

TEST(Csv, LinesKeepTheirNumbersAndEmptyOnesAreNone) {
    CsvReader r("a,b\n\"one\ntwo \"\"x\"\"\",2\n\n,\nlast\n");
    std::vector<std::pair<std::size_t, Cells>> got;
    while (auto line = r.next())
        got.emplace_back(line->number, line->cells);
    EXPECT_EQ(got, (std::vector<std::pair<std::size_t, Cells>>{{1, {"a", "b"}}, {2, {"one\ntwo \"x\"", "2"}}, {6, {"last"}}}));
    EXPECT_FALSE(r.fault());
}

TEST(Csv, AFaultHasItsLineAndWhatStandsBehindAnOpenQuoteIsNotRead) {
    const Table t("name,weight\na,1\nb,many\nc,1,2,3\nd,2\n\"e,5\nf,6\n");
    ASSERT_TRUE(t.rows);
    EXPECT_EQ(t.lines, (std::vector<std::size_t>{2, 5}));
    ASSERT_EQ(t.faults.size(), 3u);
    EXPECT_EQ(t.faults[0].line, 3u);
    EXPECT_EQ(t.faults[0].text, "weight: \"many\" is no number");
    EXPECT_EQ(t.faults[1].text, "4 cells, but 2 columns");
    EXPECT_EQ(t.faults[2].line, 6u);
    for (const std::string& wrong : {std::string(), std::string("\r\n"), std::string("nonsense\n1\n"), std::string("name,name\n"),
                                     std::string("name\n") + std::string(5000, 'x'), std::string("\"name")}) {
        const Table w(wrong);
        EXPECT_FALSE(w.faults.empty()) << wrong;
    }
    EXPECT_EQ(Table("name\na\nb\nc\nd\ne\n").faults.at(0).text, "more than 3 pears");
    for (const auto* wrong : {"name;weight\na;1,2,3\n", "name;weight\na;1.000,5\n", "name,weight\na,\"0,5\"\n"})
        EXPECT_EQ(Table(wrong).faults.size(), 1u) << wrong;
    std::string many = "weight\n";
    for (int i = 0; i < 3000; ++i)
        many += "x\n";
    EXPECT_EQ(Table(many).faults.size(), 1000u) << "of a file without end";
}

TEST(Csv, ATextComesBackAsItWasAndNoSpreadsheetCarriesItOut) {
    for (const auto* text : {"plain", "=1+1", "'=1+1", "''=1+1", "@x", "+49", "-5", "'-5", "-x", "'", "''", "a'=b",
                             "say \"x\", twice\nand; more", "\tx", " x "}) {
        const std::string cell = csv_cell(text);
        EXPECT_TRUE(cell.front() != '=' && cell.front() != '@' && (cell.front() != '"' || (cell[1] != '=' && cell[1] != '@'))) << cell;
        const std::string table = "a,b\n" + cell + ",2\n";
        CsvReader whole(table);
        (void)whole.next();
        const auto line = whole.next();
        ASSERT_TRUE(line && line->cells.size() == 2) << cell;
        EXPECT_EQ(line->cells[0], text);
    }
}

}  // namespace
}  // namespace axisgate
