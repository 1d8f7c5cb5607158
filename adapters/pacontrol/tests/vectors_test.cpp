// The golden messages of vectors.txt through the wire: texts are read and written again, frames are built byte for byte, and every printed
// form that is wrong is cut and named.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <set>
#include <sstream>

#include "adapters/pacontrol/wire_commands.hpp"
#include "adapters/pacontrol/wire_number.hpp"

namespace axisgate::pacontrol {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes bytes_of(std::istream& in) {
    Bytes b;
    std::string pair;
    while (in >> pair)
        b.push_back(static_cast<std::uint8_t>(std::stoi(pair, nullptr, 16)));
    return b;
}

struct Cut {
    std::string text, check;
    int frames = 0, faults = 0;
};
Cut cut(const Bytes& b) {
    Cut c;
    Framer f;
    f.push(b, {[&](std::string_view t, std::string_view k) {
                   c.text = t;
                   c.check = k;
                   ++c.frames;
               },
               {},
               [&](FrameFault, std::span<const std::uint8_t>) { ++c.faults; }});
    return c;
}

TEST(PacontrolVectors, EveryMessageIsReadAndWritten) {
    std::ifstream file(AXISGATE_SOURCE_DIR "/adapters/pacontrol/vectors.txt");
    ASSERT_TRUE(file);
    std::string line, text, name;
    bool down = true;
    int texts = 0, built = 0, printed = 0, zeros = 0;
    std::set<std::uint16_t> codes;
    while (std::getline(file, line)) {
        if (const auto hash = line.find('#'); hash != std::string::npos) line.erase(hash);
        std::istringstream in(line);
        std::string key;
        if (!(in >> key)) continue;
        SCOPED_TRACE(testing::Message() << name << ": " << line);
        const CheckForm rule = down ? CheckForm::text : CheckForm::with_etx;
        if (key == "case") {
            in >> name;
        } else if (key == ">" || key == "<") {
            down = key == ">";
            in >> text;
            ++texts;
            std::string fault;
            if (down) {
                const auto r = request_of(text, fault);
                ASSERT_TRUE(r) << fault;
                codes.insert(r->code);
                EXPECT_EQ(request_of(text_of(*r), fault), r);
                EXPECT_FALSE(describe(*r).empty());
            } else {
                const auto r = reply_of(text, fault);
                ASSERT_TRUE(r) << fault;
                EXPECT_EQ(text_of(*r), text);
                EXPECT_TRUE(number_of(*r));
                EXPECT_TRUE(r->real || integer_of(r->data)) << "type 0 is a whole number";
            }
        } else if (key == "bytes") {
            const Bytes b = bytes_of(in);
            ++built;
            const Cut c = cut(b);
            EXPECT_EQ(c.frames, 1);
            EXPECT_EQ(c.text, text);
            const auto form = form_of_check(c.text, c.check, rule);
            if (form != CheckForm::zero) {  // the legal 0 in place of a sum
                EXPECT_EQ(form, rule);
            }
            zeros += form == CheckForm::zero;
            EXPECT_EQ(framed(text, form.value_or(rule)), b);
        } else if (key == "printed") {
            ++printed;
            Bytes b;
            std::string word, verdict;
            while (in >> word) {
                if (word.size() == 2 && verdict.empty()) {
                    b.push_back(static_cast<std::uint8_t>(std::stoi(word, nullptr, 16)));
                } else if (verdict.empty()) {
                    verdict = word;
                }
            }
            const Cut c = cut(b);
            ASSERT_EQ(c.frames, 1) << "the tolerant reader cuts it";
            const auto form = form_of_check(c.text, c.check, rule);
            if (verdict == "check") {
                EXPECT_EQ(form, std::nullopt);
                EXPECT_EQ(c.text, text);
            } else if (verdict == "other") {
                EXPECT_TRUE(form && form != rule && form != CheckForm::zero);
                EXPECT_EQ(c.text, text);
            } else {
                EXPECT_EQ(verdict, "text");
                EXPECT_NE(c.text, text);
            }
        }
    }
    EXPECT_GT(texts, 40);
    EXPECT_GE(built, 17);
    EXPECT_GE(printed, 5);
    for (const CommandInfo& c : all_commands())
        EXPECT_TRUE(codes.contains(c.code)) << c.name << " has no case";
    EXPECT_EQ(zeros, 1);
    EXPECT_LE(std::ranges::count_if(codes, [](std::uint16_t c) { return !command_info(c); }), 1) << "one case is an unknown command";
}

}  // namespace
}  // namespace axisgate::pacontrol
