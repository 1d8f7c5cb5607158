// program.edit: part of a program replaced: what stays keeps its lines and addresses, a fault changes nothing, a broken edit leaves no
// half. In: programs, edits, embedded drives on a line with honest wire time. Out: results, what the drive lists.
#include <fmt/core.h>

#include "adapters/mcode/tests/line_bench.hpp"

namespace axisgate::mcode::test {
namespace {

constexpr const char* program = "VA Q1=7\nPG 1\nLB A1\nR1=Q1\nCL K1\nE\nLB K1\nR2=1\nRT\nLB B1\nR3=1\nE\nPG\n";

struct EditBench : LineBench {
    explicit EditBench(std::map<std::string, std::string> options = {}) : LineBench("ab", 19200, std::move(options)) {
        run(6s);
        const Result r = wait(Action{"program.download", program});
        EXPECT_EQ(r.outcome, Outcome::done) << r.text;
    }
    Result edit(std::string_view text) { return wait(Action{"program.edit", std::string(text)}, 0, 30s); }
    std::string text() { return wait(Action{"program.upload", ""}).text; }
    std::string list() { return wait(Action{"program.list", ""}).text; }
};

TEST(McodeEdit, FromALabelOnTheProgramIsAnotherAndTheRestStays) {
    for (const int ck : {0, 1, 2}) {
        for (const int em : {0, 1, 2, 3}) {
            EditBench b({{"ck", std::to_string(ck)}, {"em", std::to_string(em)}});
            const std::string before = b.list();
            const Result r = b.edit("k1\nLB K1 ' again\nR2=Q1\nR4=2\nRT\nLB K2\nBR A1\nE\n");
            EXPECT_EQ(r.outcome, Outcome::done) << ck << em << r.text;
            EXPECT_TRUE(r.text.starts_with("11 statements stored and verified")) << r.text;
            EXPECT_EQ(b.text(), "LB A1\nR1=Q1\nCL K1\nE\nLB K1 ' again\nR2=Q1\nR4=2\nRT\nLB K2\nBR A1\nE\n") << ck << em;
            const std::string after = b.list(), head = before.substr(0, before.find("LB K1"));
            EXPECT_EQ(after.substr(0, head.size()), head) << "addresses of what stays";
            EXPECT_EQ(b.wait(Native{{'P', 'R', ' ', 'Q', '1'}, true}).text, "7") << "the user variables stay";
        }
    }
}

TEST(McodeEdit, ByAnAddressAndWithoutLinesItEndsThere) {
    EditBench b;
    const std::string rows = b.list();
    const auto at = rows.find("LB B1");
    const auto begin = rows.rfind('\n', at) + 1;
    const std::string address = rows.substr(begin, at - begin - 1);
    Result r = b.edit(address + "\n");
    EXPECT_EQ(r.outcome, Outcome::done) << r.text;
    EXPECT_EQ(b.text(), "LB A1\nR1=Q1\nCL K1\nE\nLB K1\nR2=1\nRT\n");
    r = b.edit("A1\nLB A1\nE\nLB K3\nE");
    EXPECT_EQ(r.outcome, Outcome::done) << r.text;
    EXPECT_EQ(b.text(), "LB A1\nE\nLB K3\nE\n") << "from the first line on";
    EXPECT_EQ(b.wait(Action{"program.start", "K3"}).outcome, Outcome::accepted);
}

TEST(McodeEdit, AFaultIsToldAndChangesNothing) {
    EditBench b;
    const std::string before = b.list();
    const std::pair<std::string, std::string> rows[] = {
        {"", "in the first line"},
        {"Z9\nE", "no label Z9"},
        {"2\nE", "begins at address 2"},
        {"K1\nLB K1\nMA Q9\nRT", "line 3"},
        {"K1\nLB K1\nRT\nLB A1\nE", "line 4"},
        {"K1\nLB K4\nRT", "the part that stays does not fit any more"},
        {"K1\nPG 1\nLB K1\nRT\nPG", "line"},
        {"A1", "program.clear"},
    };
    for (const auto& [text, why] : rows) {
        const Result r = b.edit(text);
        EXPECT_EQ(r.outcome, Outcome::refused) << text;
        EXPECT_NE(r.text.find(why), std::string::npos) << text << ": " << r.text;
    }
    EXPECT_EQ(b.list(), before);
}

TEST(McodeEdit, ABrokenEditLeavesWhatStoodBeforeIt) {
    for (const bool away : {false, true}) {
        EditBench b;
        const Ticket t = b.command(Action{"program.edit", "K1\nLB K1\nR2=5\nR4=2\nRT\nLB K2\nE\n"});
        const auto sent = [&](std::string_view part) {
            return std::ranges::any_of(b.sent, [&](const auto& s) { return s.bytes.find(part) != std::string::npos; });
        };
        for (int i = 0; i < 4000 && !sent("R4=2"); ++i)
            b.run(2ms);
        ASSERT_TRUE(sent("R4=2"));
        if (away) {
            b.on_line_state(false, "cut");
            b.drain();
            b.run(500ms);
            b.on_line_state(true, "again");
            b.drain();
        } else {
            (void)b.command(Halt{});
        }
        b.run(12s);
        ASSERT_TRUE(b.result(t));
        EXPECT_EQ(b.result(t)->outcome, Outcome::failed);
        EXPECT_NE(b.result(t)->text.find("edit again"), std::string::npos) << b.result(t)->text;
        ASSERT_TRUE(b.online());
        EXPECT_EQ(b.text(), "LB A1\nR1=Q1\nCL K1\nE\n") << "away " << away;
    }
}

}  // namespace
}  // namespace axisgate::mcode::test
