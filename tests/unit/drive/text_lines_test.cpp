// How a stream is cut into lines, with any boundaries of its runs; a decoder's sentences at the ends of a recording.
#include "gateway/drive/text_lines.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace axisgate::drive {
namespace {
using testing::ElementsAre;

std::vector<std::string> cut(TextLines lines, std::string_view bytes, std::size_t piece) {
    std::vector<std::string> all;
    for (; !bytes.empty(); bytes.remove_prefix(std::min(piece, bytes.size())))
        lines.push(bytes.substr(0, piece), [&](std::string_view line) { all.emplace_back(line); });
    if (std::string rest = lines.take_rest(); !rest.empty()) all.push_back("rest " + rest);
    return all;
}

TEST(TextLines, AreTheSameHoweverTheBytesCome) {
    const std::string bytes = "tail\r@one\r\r@tw@three\r0123456789@four\r#fi";
    const auto whole = cut({'\r', "@#", 8}, bytes, bytes.size());
    EXPECT_THAT(whole, ElementsAre("tail", "@one", "@tw", "@three", "01234567", "89", "@four", "rest #fi"));
    for (std::size_t piece = 1; piece < bytes.size(); ++piece)
        EXPECT_EQ(cut({'\r', "@#", 8}, bytes, piece), whole) << piece;
}

TEST(TextLines, WithoutAStartOnlyTheEndEnds) { EXPECT_THAT(cut({'\n', "", 80}, "a@b\nc", 2), ElementsAre("a@b", "rest c")); }

struct Numbers final : TextDecoder {
    Numbers() : TextDecoder({'\n', "", 20}) {}
    [[nodiscard]] std::optional<std::string> sentence(std::string_view line) const override {
        if (line.find_first_not_of("0123456789") != line.npos) return std::nullopt;
        return "the number " + std::string(line);
    }
};

TEST(TextDecoder, TellsWhatARecordingHasAtItsEdges) {
    const auto frame = [](std::string_view text) { return Frame::run(bytes_of(text)); };
    Numbers d;
    EXPECT_THAT(d.on_frame(frame("x7\n12\nx\x01\n3"), true),
                ElementsAre("the end of a telegram that began before the recording: x7", "the number 12", "unknown, no telegram: x."));
    EXPECT_THAT(d.on_frame(frame("y\n"), false), ElementsAre("the end of a telegram that began before the recording: y"))
        << "each direction by itself";
    EXPECT_THAT(d.finish(), ElementsAre("a telegram that had not ended when the recording did: 3"));
    EXPECT_TRUE(d.finish().empty());
    EXPECT_THAT(d.on_frame(Frame::can_extended(5, bytes_of("4\n")), true), ElementsAre("the number 4")) << "text in CAN frames is text";
}

}  // namespace
}  // namespace axisgate::drive
