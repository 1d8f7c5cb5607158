// What a drive's language can show and what it cannot, as users meet it: the listing of everything, trips, registers of real numbers.
// In: reads, writes and actions to a real twin on a bus in virtual time. Out: one result each, with its value or its sentence.
// Never looks inside the twin.
#include <limits>

#include "adapters/mcode/tests/line_bench.hpp"

namespace axisgate::mcode::test {
namespace {

struct Reader : LineBench {
    Reader() : LineBench("a", 115200) {
        run(8s);
        EXPECT_TRUE(online());
    }
    Result read(const char* id) { return wait(ReadParameter{*catalogue().find(id)}); }
    Result write(const char* id, Value v) { return wait(WriteParameter{*catalogue().find(id), std::move(v)}); }
};

TEST(McodeReadable, EverythingIsListedByAnAction) {
    Reader b;
    const Result all = b.wait(Action{"AL", ""}, 0, 20s);
    ASSERT_EQ(all.outcome, Outcome::done) << all.text;
    const std::string list = to_text(all.value);
    EXPECT_NE(list.find("VM = 768000"), std::string::npos) << list;
    EXPECT_NE(list.find("WT = "), std::string::npos) << "the last word: " << list;
}

TEST(McodeReadable, TripsAreSaidNotToBe) {
    Reader b;
    for (const char* trip : {"TI", "TP", "TC", "TT", "TR", "TA", "TM"}) {
        const auto point = catalogue().find(trip);
        ASSERT_TRUE(point) << trip;
        const Parameter& p = *catalogue().parameter(*point);
        EXPECT_FALSE(p.readable()) << trip;
        EXPECT_TRUE(p.writable()) << trip;
        EXPECT_NE(p.description.find("The language has no way to show it."), std::string::npos) << trip << ": " << p.description;
        const Result r = b.read(trip);
        EXPECT_EQ(r.outcome, Outcome::refused) << trip;
        EXPECT_NE(r.text.find(trip), std::string::npos) << r.text;
        EXPECT_TRUE(std::ranges::none_of(
            b.sent, [&](const LineBench::Sent& s) { return s.bytes.find(std::string("PR ") + trip) != std::string::npos; }))
            << trip << " was asked for";
    }
    EXPECT_EQ(as_integer(b.read("TE").value), 0) << "which of them are armed is shown";
}

/// [L2819, L2820]: the whole range of a double, checked before the wire; the drive keeps what it was given.
TEST(McodeReadable, RealRegistersHoldADoublesRange) {
    Reader b;
    for (int n = 1; n <= 8; ++n) {
        const std::string id = "F" + std::to_string(n);
        for (const double v : {1.5e6 * n, -3.25}) {
            const Result r = b.write(id.c_str(), Value{v});
            EXPECT_EQ(r.outcome, Outcome::done) << id << "=" << v << ": " << r.text;
            EXPECT_EQ(as_number(b.read(id.c_str()).value), v) << id;
        }
        for (const double v : {1.7976931348623157e308, -1.7976931348623157e308}) {
            const Result r = b.write(id.c_str(), Value{v});
            EXPECT_EQ(r.outcome, Outcome::done) << id << "=" << v << ": " << r.text;
        }
        EXPECT_NE(catalogue().check_write(*catalogue().find(id), Value{std::numeric_limits<double>::infinity()}).fault, "") << id;
    }
}

}  // namespace
}  // namespace axisgate::mcode::test
