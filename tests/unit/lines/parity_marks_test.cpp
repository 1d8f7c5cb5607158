// ParityMarks: the kernel's marks in every cut.
// In: bytes. Out: pass or fail. Never needs a port.
#include "gateway/lines/parity_marks.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace axisgate {
namespace {

std::string through(const std::string& bytes, std::size_t piece, std::uint64_t& bad) {
    ParityMarks marks;
    std::string out;
    for (std::size_t i = 0; i < bytes.size(); i += piece) {
        std::vector<std::uint8_t> part(bytes.begin() + static_cast<std::ptrdiff_t>(i),
                                       bytes.begin() + static_cast<std::ptrdiff_t>(std::min(bytes.size(), i + piece)));
        const std::size_t n = marks.take_out(part);
        EXPECT_LE(n, part.size());
        out.append(part.begin(), part.begin() + static_cast<std::ptrdiff_t>(n));
    }
    bad = marks.bad();
    return out;
}

TEST(ParityMarks, areTakenOutHoweverTheBytesAreCut) {
    const struct {
        std::string in, out;
        std::uint64_t bad;
    } rows[] = {
        {"PR P=12\r", "PR P=12\r", 0},
        {std::string("\0\1\2", 3), std::string("\0\1\2", 3), 0},
        {"\xFF\xFF", "\xFF", 0},
        {"a\xFF\xFF\xFF\xFF"
         "b",
         "a\xFF\xFF"
         "b",
         0},
        {std::string("12\xFF\0"
                     "34",
                     6),
         std::string("12\0"
                     "4",
                     4),
         1},                                                                  // the 3 came badly
        {std::string("\xFF\0\0", 3), std::string("\0", 1), 1},                // a break
        {std::string("\xFF\0\xFF\xFF\xFF", 5), std::string("\0\xFF", 2), 1},  // a bad byte that was itself 377
        {std::string("\xFF\0x\xFF\0y", 6), std::string("\0\0", 2), 2},
        {std::string("\xFFz", 2), "z", 0},  // not the kernel's way: nothing is lost
        {std::string("end\xFF", 4), "end", 0},
    };
    for (const auto& r : rows) {
        for (std::size_t piece = 1; piece <= r.in.size(); ++piece) {
            std::uint64_t bad = 0;
            EXPECT_EQ(through(r.in, piece, bad), r.out) << "in pieces of " << piece;
            EXPECT_EQ(bad, r.bad);
        }
    }
}

TEST(ParityMarks, beginAnewWithThePort) {
    ParityMarks marks;
    std::vector<std::uint8_t> half{0xFF, 0};
    EXPECT_EQ(marks.take_out(half), 0u);
    marks.reset();
    std::vector<std::uint8_t> fresh{'o', 'k'};
    EXPECT_EQ(marks.take_out(fresh), 2u);
    EXPECT_EQ(marks.bad(), 0u);
}

}  // namespace
}  // namespace axisgate
