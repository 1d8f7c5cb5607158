// Reading and writing parameters through registers 48..54, as clients do it, with requests in hex.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>

#include "tests/unit/modbus/responder_bench.hpp"

namespace axisgate::modbus {
namespace {
using namespace registers;
using test::ResponderBench;

// Positions in test::catalogue()
enum : std::uint16_t {
    par_i32,
    par_u32,
    par_i16_read,
    par_u16_write,
    par_text,
    par_f64,
    par_array,
    par_bool,
    par_i64,
    par_bytes,
    par_allowed
};

struct Channel : ResponderBench {
    explicit Channel(WordOrder order = WordOrder::high_first) : ResponderBench(order), order_(order) {
        axis = port.add_axis(1, &test::catalogue());
    }
    static std::string word(std::uint16_t v) {
        std::uint8_t b[2];
        put16(b, v);
        return " " + test::hex(b);
    }
    std::string pair(std::uint32_t v) const {
        std::uint8_t b[4];
        put32(b, v, order_);
        return " " + test::hex(b);
    }
    /// Selector and request in one write. Returns the answer.
    std::string start(std::uint32_t selector, std::uint16_t request) { return ask("10 00 30 00 03 06" + pair(selector) + word(request)); }
    std::string put_value(std::uint32_t v) { return ask("10 00 34 00 02 04" + pair(v)); }
    struct Seen {
        int state;
        std::uint32_t value;
        int error;
        bool operator==(const Seen&) const = default;
    };
    Seen look() {
        const auto a = test::bytes(ask("03 00 33 00 04"));
        return {get16(a.data() + 2), get32(a.data() + 4, order_), get16(a.data() + 8)};
    }
    AxisId axis;
    WordOrder order_;
};
void PrintTo(const Channel::Seen& s, std::ostream* out) { *out << "state " << s.state << " value " << s.value << " error " << s.error; }
using Seen = Channel::Seen;
constexpr int idle = 0, busy = 1, done = 2, refused = 3;
constexpr const char* accepted = "10 00 30 00 03";
constexpr std::uint32_t float_form = 1u << 31;
std::uint32_t single(float f) { return std::bit_cast<std::uint32_t>(f); }
constexpr auto out_of_range_number = static_cast<int>(Reason::out_of_range);

TEST(ParameterChannel, FractionsGoInTheFloatForm) {
    for (const auto order : {WordOrder::high_first, WordOrder::low_first}) {
        Channel c(order);
        const auto read_as = [&](std::uint32_t parameter, Value reported) {
            c.result = [] {};
            EXPECT_EQ(c.start(parameter | float_form, 1), accepted);
            c.port.answer(Outcome::done, Reason::none, 0, std::move(reported));
            return c.look();
        };
        EXPECT_EQ(read_as(par_f64, Value{-2.5}), (Seen{done, single(-2.5F), 0}));
        EXPECT_EQ(read_as(par_f64, Value{0.1}), (Seen{done, single(0.1F), 0})) << "the nearest one";
        EXPECT_EQ(read_as(par_i32, Value{std::int64_t{-7}}), (Seen{done, single(-7.0F), 0})) << "whole numbers too";
        EXPECT_EQ(read_as(par_i64, Value{std::int64_t{1} << 40}), (Seen{done, single(1099511627776.0F), 0}))
            << "and those that i32 cannot show";
        EXPECT_EQ(read_as(par_f64, Value{1e39}).state, refused) << "more than a single can be";
        EXPECT_EQ(c.look().error, out_of_range_number);
        EXPECT_EQ(read_as(par_array + (4u << 16), Value{std::int64_t{5}}), (Seen{done, single(5.0F), 0}));
    }
}

TEST(ParameterChannel, WritesInTheFloatForm) {
    Channel c;
    const auto write = [&](std::uint32_t selector, float value) {
        c.result = [] {};
        EXPECT_EQ(c.put_value(single(value)), "10 00 34 00 02");
        EXPECT_EQ(c.start(selector | float_form, 2), accepted);
        return c.look();
    };
    EXPECT_EQ(write(par_f64, 0.1F).state, busy);
    EXPECT_EQ(std::get<WriteParameter>(c.port.commands.front().body).value, Value{0.1}) << "and not 0.10000000149011612";
    c.port.answer(Outcome::done, Reason::none, 0, Value{0.25});
    EXPECT_EQ(c.look(), (Seen{done, single(0.25F), 0})) << "what the drive took";
    EXPECT_EQ(write(par_i32, 12.0F).state, busy);
    EXPECT_EQ(std::get<WriteParameter>(c.port.commands.front().body).value, Value{std::int64_t{12}});
    c.port.answer(Outcome::done, Reason::none, 0, Value{std::int64_t{12}});
    for (const float wrong : {0.5F, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), 1001.0F})
        EXPECT_EQ(write(par_i32, wrong), (Seen{refused, single(wrong), out_of_range_number})) << wrong;
    EXPECT_EQ(write(par_f64, std::numeric_limits<float>::quiet_NaN()).state, refused);
}

TEST(ParameterChannel, ARefusalLeavesItsSentence) {
    Channel c;
    EXPECT_EQ(c.put_value(1001), "10 00 34 00 02");
    EXPECT_EQ(c.start(par_i32, 2), accepted);
    c.result = [] {};
    EXPECT_EQ(c.start(par_f64, 1), accepted);
    c.port.answer(Outcome::done, Reason::none, 0, Value{2.5});
    EXPECT_EQ(c.start(par_i32, 1), accepted);
    EXPECT_EQ(c.start(par_i32, 1), "90 06");
    c.port.answer(Outcome::refused, Reason::drive_refused, 51, {}, "axis x: the drive refused A: code 51");
    std::string texts;
    for (const auto& [e, axis] : c.port.notes) {
        texts += e.parameter + "|" + e.text + "\n";
        EXPECT_EQ(axis, c.axis);
        EXPECT_EQ(e.who, "192.0.2.7:51123");
        EXPECT_EQ(e.severity, Severity::warning);
    }
    EXPECT_EQ(texts,
              "A|A: 1001 is outside -1000..1000 (unit 1 registers 48..50 = 0 0 2: the parameter channel shows it)\n"
              "F|F is 2.5, which is no whole number of 32 bits: read it in the float form (bit 31 of the selector) (unit 1 registers "
              "48..50 = 0 5 1: the parameter "
              "channel shows it)\n"
              "|the parameter channel is busy: write again when register 51 of the axis is no longer 1 (unit 1 registers 48..50 = 0 0 1: "
              "exception 6)\n"
              "A|axis x: the drive refused A: code 51 (unit 1 registers 48..50 = 0 0 1: the parameter channel shows it)\n");
    EXPECT_EQ(c.ask("03 00 14 00 02"), "03 04 00 06 00 04") << "reason of the last, and how many";
}

TEST(ParameterChannel, Read) {
    for (const auto order : {WordOrder::high_first, WordOrder::low_first}) {
        Channel c(order);
        EXPECT_EQ(c.start(par_i32, 1), accepted);
        EXPECT_FALSE(c.waited) << "the write is answered at once; the state tells the rest";
        EXPECT_EQ(c.look(), (Seen{busy, 0, 0}));
        ASSERT_EQ(c.port.commands.size(), 1u);
        EXPECT_EQ(c.port.commands.front().axis, c.axis);
        EXPECT_EQ(std::get<ReadParameter>(c.port.commands.front().body).point, (Point{par_i32, 0}));
        EXPECT_EQ(c.port.commands.front().origin.text(), "modbus 192.0.2.7:51123");
        c.port.answer(Outcome::done, Reason::none, 0, Value{std::int64_t{-2}});
        EXPECT_EQ(c.look(), (Seen{done, 0xFFFFFFFE, 0}));
        EXPECT_EQ(c.ask("03 00 30 00 03"), "03 06 00 00 00 00 00 01") << "selector and request read back";
    }
}

TEST(ParameterChannel, Write) {
    for (const auto order : {WordOrder::high_first, WordOrder::low_first}) {
        Channel c(order);
        EXPECT_EQ(c.put_value(static_cast<std::uint32_t>(-999)), "10 00 34 00 02");
        EXPECT_EQ(c.look(), (Seen{idle, static_cast<std::uint32_t>(-999), 0}));
        EXPECT_EQ(c.start(par_i32, 2), accepted);
        ASSERT_EQ(c.port.commands.size(), 1u);
        const auto& w = std::get<WriteParameter>(c.port.commands.front().body);
        EXPECT_EQ(w.point, (Point{par_i32, 0}));
        EXPECT_EQ(w.value, Value{std::int64_t{-999}});
        EXPECT_EQ(c.look().state, busy);
        c.port.answer(Outcome::done, Reason::none, 0, Value{std::int64_t{-998}});
        EXPECT_EQ(c.look(), (Seen{done, static_cast<std::uint32_t>(-998), 0})) << "what the drive took";
    }
}

TEST(ParameterChannel, WriteWithoutAValueInTheResultKeepsWhatWasWritten) {
    Channel c;
    EXPECT_EQ(c.put_value(7), "10 00 34 00 02");
    EXPECT_EQ(c.start(par_i32, 2), accepted);
    c.port.answer(Outcome::accepted);
    EXPECT_EQ(c.look(), (Seen{done, 7, 0}));
}

TEST(ParameterChannel, SelectorOfAnArrayElement) {
    Channel c;
    EXPECT_EQ(c.start(par_array | (5u << 16), 1), accepted);
    EXPECT_EQ(std::get<ReadParameter>(c.port.commands.front().body).point, (Point{par_array, 5}));
    c.port.answer(Outcome::done, Reason::none, 0, Value{std::int64_t{0x01020304}});
    EXPECT_EQ(c.ask("03 00 30 00 07"), "03 0E 00 05 00 06 00 01 00 02 01 02 03 04 00 00");
}

TEST(ParameterChannel, SingleRegisterRequest) {
    Channel c;
    EXPECT_EQ(c.ask("10 00 30 00 02 04" + c.pair(par_u32)), "10 00 30 00 02");
    EXPECT_EQ(c.look().state, idle) << "a selector alone starts nothing";
    EXPECT_EQ(c.ask("06 00 32 00 01"), "06 00 32 00 01");
    EXPECT_EQ(std::get<ReadParameter>(c.port.commands.front().body).point, (Point{par_u32, 0}));
    c.port.answer(Outcome::done, Reason::none, 0, Value{std::int64_t{1}});
    EXPECT_EQ(c.ask("16 00 32 00 00 00 01"), "16 00 32 00 00 00 01") << "mask write starts it too";
    EXPECT_EQ(c.port.commands.size(), 1u);
}

TEST(ParameterChannel, ReadWriteFunctionStartsAndShows) {
    Channel c;
    EXPECT_EQ(c.ask("17 00 33 00 01 00 30 00 03 06 00 00 00 00 00 01"), "17 02 00 01");
}

struct RefusedCase {
    const char* name;
    std::uint32_t selector;
    std::uint16_t request;
    std::uint32_t value;
    Reason reason;
};
class ParameterChannelRefused : public testing::TestWithParam<RefusedCase> {};
TEST_P(ParameterChannelRefused, BeforeAnythingGoesToTheLine) {
    Channel c;
    EXPECT_EQ(c.put_value(GetParam().value), "10 00 34 00 02");
    EXPECT_EQ(c.start(GetParam().selector, GetParam().request), accepted);
    EXPECT_EQ(c.look(), (Seen{refused, GetParam().value, static_cast<int>(GetParam().reason)}));
    EXPECT_EQ(c.port.submitted, 0u);
}
INSTANTIATE_TEST_SUITE_P(Table, ParameterChannelRefused,
                         testing::Values(RefusedCase{"read_unknown", 11, 1, 5, Reason::unknown_point},
                                         RefusedCase{"write_unknown", 0xFFFF, 2, 5, Reason::unknown_point},
                                         RefusedCase{"element_of_what_is_no_array", par_i32 | (1u << 16), 1, 5, Reason::unknown_point},
                                         RefusedCase{"element_below_the_first", par_array | (2u << 16), 1, 5, Reason::unknown_point},
                                         RefusedCase{"element_beyond_the_last", par_array | (7u << 16), 1, 5, Reason::unknown_point},
                                         RefusedCase{"array_without_element", par_array, 1, 5, Reason::unknown_point},
                                         RefusedCase{"write_read_only", par_i16_read, 2, 5, Reason::not_writable},
                                         RefusedCase{"read_write_only", par_u16_write, 1, 5, Reason::not_supported},
                                         RefusedCase{"read_text", par_text, 1, 5, Reason::not_supported},
                                         RefusedCase{"write_text", par_text, 2, 5, Reason::not_supported},
                                         RefusedCase{"read_bytes", par_bytes, 1, 5, Reason::not_supported},
                                         RefusedCase{"above_max", par_i32, 2, 1001, Reason::out_of_range},
                                         RefusedCase{"below_min", par_i32, 2, 0xFFFFFC17, Reason::out_of_range},  // -1001
                                         RefusedCase{"bool_2", par_bool, 2, 2, Reason::out_of_range},
                                         RefusedCase{"not_one_of_the_allowed", par_allowed, 2, 2, Reason::out_of_range},
                                         RefusedCase{"u16_minus_1", par_u16_write, 2, 0xFFFFFFFF, Reason::out_of_range}),
                         [](const auto& i) { return i.param.name; });

struct ValueCase {
    const char* name;
    std::uint16_t parameter;
    std::uint32_t bits;
    Value value;
};
class ParameterChannelValue : public testing::TestWithParam<ValueCase> {};
TEST_P(ParameterChannelValue, BothWays) {
    Channel c;
    EXPECT_EQ(c.put_value(GetParam().bits), "10 00 34 00 02");
    EXPECT_EQ(c.start(GetParam().parameter, 2), accepted);
    ASSERT_EQ(c.port.commands.size(), 1u);
    EXPECT_EQ(std::get<WriteParameter>(c.port.commands.front().body).value, GetParam().value);
    c.port.answer();
    EXPECT_EQ(c.put_value(0), "10 00 34 00 02");
    EXPECT_EQ(c.start(GetParam().parameter, 1), accepted);
    c.port.answer(Outcome::done, Reason::none, 0, GetParam().value);
    EXPECT_EQ(c.look(), (Seen{done, GetParam().bits, 0}));
}
INSTANTIATE_TEST_SUITE_P(Table, ParameterChannelValue,
                         testing::Values(ValueCase{"i32_negative", par_i32, 0xFFFFFFFE, Value{std::int64_t{-2}}},
                                         ValueCase{"u32_is_unsigned", par_u32, 0xFFFFFFFE, Value{std::int64_t{0xFFFFFFFE}}},
                                         ValueCase{"i64_sign_extends", par_i64, 0x80000000, Value{std::int64_t{-2147483648LL}}},
                                         ValueCase{"f64_whole", par_f64, 0xFFFFFFFB, Value{-5.0}},
                                         ValueCase{"bool", par_bool, 1, Value{true}},
                                         ValueCase{"allowed", par_allowed, 6, Value{std::int64_t{6}}}),
                         [](const auto& i) { return i.param.name; });

TEST(ParameterChannel, AReadValueThatDoesNotFitIsRefusedNotCut) {
    struct Row {
        std::uint16_t parameter;
        Value value;
    };
    for (const Row& row : {Row{par_i64, Value{std::int64_t{1} << 31}}, Row{par_i64, Value{-(std::int64_t{1} << 31) - 1}},
                           Row{par_f64, Value{0.5}}, Row{par_u32, Value{std::int64_t{1} << 32}}, Row{par_u32, Value{std::int64_t{-1}}},
                           Row{par_i32, Value{}}, Row{par_i32, Value{std::string("x")}}}) {
        Channel c;
        EXPECT_EQ(c.start(row.parameter, 1), accepted);
        c.port.answer(Outcome::done, Reason::none, 0, row.value);
        EXPECT_EQ(c.look(), (Seen{refused, 0, static_cast<int>(Reason::out_of_range)})) << to_text(row.value);
    }
}

TEST(ParameterChannel, AWriteThatHappenedIsDoneWhateverCameBack) {
    Channel c;
    EXPECT_EQ(c.put_value(3), "10 00 34 00 02");
    EXPECT_EQ(c.start(par_f64, 2), accepted);
    c.port.answer(Outcome::done, Reason::none, 0, Value{2.999});
    EXPECT_EQ(c.look(), (Seen{done, 3, 0}));
}

TEST(ParameterChannel, RefusedByTheDriveShowsItsCodeElseTheReason) {
    struct Row {
        Reason reason;
        std::int32_t code;
        int error;
    };
    for (const Row& row : {Row{Reason::drive_refused, 23, 23}, Row{Reason::drive_refused, 0, 6}, Row{Reason::no_answer, 0, 9},
                           Row{Reason::line_down, 0, 8}, Row{Reason::none, 0, 13}, Row{Reason::wrong_state, 0xABCD, 0xABCD},
                           Row{Reason::drive_refused, 0x70000, 6}, Row{Reason::drive_refused, -1, 0xFFFF}}) {
        Channel c;
        EXPECT_EQ(c.start(par_i32, 1), accepted);
        c.port.refuse(row.reason, row.code);
        EXPECT_EQ(c.look(), (Seen{refused, 0, row.error})) << name_of(row.reason) << " " << row.code;
        EXPECT_EQ(c.start(par_i32, 1), accepted) << "and it can be tried again";
        EXPECT_EQ(c.look(), (Seen{busy, 0, 0}));
    }
}

TEST(ParameterChannel, WhileBusyEveryWriteToItIsBusy) {
    Channel c;
    EXPECT_EQ(c.start(par_i32, 1), accepted);
    EXPECT_EQ(c.start(par_u32, 1), "90 06");
    EXPECT_EQ(c.start(par_u32, 2), "90 06");
    EXPECT_EQ(c.ask("06 00 32 00 01"), "86 06");
    EXPECT_EQ(c.ask("06 00 32 00 00"), "86 06");
    EXPECT_EQ(c.put_value(9), "90 06");
    EXPECT_EQ(c.ask("16 00 32 00 00 00 01"), "96 06");
    EXPECT_EQ(c.ask("17 00 33 00 01 00 32 00 01 02 00 01"), "97 06");
    EXPECT_EQ(c.port.submitted, 1u);
    EXPECT_EQ(c.ask("06 00 20 00 06"), "06 00 20 00 06") << "set-points are not held up";
    c.port.answer(Outcome::done, Reason::none, 0, Value{std::int64_t{4}});
}

TEST(ParameterChannel, RequestNumbers) {
    Channel c;
    EXPECT_EQ(c.ask("06 00 32 00 03"), "86 03");
    EXPECT_EQ(c.ask("06 00 32 FF FF"), "86 03");
    EXPECT_EQ(c.start(par_u32, 3), "90 03");
    EXPECT_EQ(c.ask("03 00 30 00 03"), "03 06 00 00 00 00 00 00") << "a refused write changes nothing, not the selector either";
    EXPECT_EQ(c.start(99, 1), accepted);
    EXPECT_EQ(c.look().state, refused);
    EXPECT_EQ(c.ask("06 00 32 00 00"), "06 00 32 00 00");
    EXPECT_EQ(c.look(), (Seen{idle, 0, 0})) << "0 brings it back to idle";
}

TEST(ParameterChannel, EachAxisHasItsOwn) {
    Channel c;
    const AxisId second = c.port.add_axis(2, &test::catalogue());
    EXPECT_EQ(c.start(par_i32, 1), accepted);
    EXPECT_EQ(c.ask("10 00 70 00 03 06 00 00 00 01 00 01"), "10 00 70 00 03");
    EXPECT_EQ(c.port.commands.back().axis, second);
    EXPECT_EQ(c.ask("03 00 33 00 01"), "03 02 00 01");
    EXPECT_EQ(c.ask("03 00 73 00 01"), "03 02 00 01");
    c.port.answer(Outcome::done, Reason::none, 0, Value{std::int64_t{4}});
    EXPECT_EQ(c.ask("03 00 33 00 01"), "03 02 00 02");
    EXPECT_EQ(c.ask("03 00 73 00 01"), "03 02 00 01");
}

TEST(ParameterChannel, AResultThatNeverComesEndsAsNoAnswer) {
    Channel c;
    EXPECT_EQ(c.start(par_i32, 1), accepted);
    c.port.time += std::chrono::seconds(30);
    c.responder.writer().sweep(c.port.time);
    EXPECT_EQ(c.look(), (Seen{refused, 0, static_cast<int>(Reason::no_answer)}));
    EXPECT_EQ(c.start(par_u32, 1), accepted);
    c.port.answer(Outcome::done, Reason::none, 0, Value{std::int64_t{111}});  // of the first
    EXPECT_EQ(c.look(), (Seen{busy, 0, 0})) << "a late answer is not taken for the next one's";
    c.port.answer(Outcome::done, Reason::none, 0, Value{std::int64_t{222}});
    EXPECT_EQ(c.look(), (Seen{done, 222, 0}));
}

TEST(ParameterChannel, AReplacedAxisHasAFreshChannel) {
    Channel c;
    EXPECT_EQ(c.start(par_i32, 1), accepted);
    c.port.add_axis(1, &test::catalogue());
    EXPECT_EQ(c.look(), (Seen{idle, 0, 0}));
    EXPECT_EQ(c.start(par_u32, 1), accepted);
    c.port.answer(Outcome::done, Reason::none, 0, Value{std::int64_t{111}});  // of the old axis
    EXPECT_EQ(c.look(), (Seen{busy, 0, 0}));
    c.port.remove_axis(1);
    EXPECT_EQ(c.start(par_u32, 1), "90 0A");
    c.port.answer(Outcome::done, Reason::none, 0, Value{std::int64_t{222}});
}

TEST(ParameterChannel, WithoutACatalogueItSaysSo) {
    Channel c;
    c.port.add_axis(1, nullptr);
    EXPECT_EQ(c.start(par_i32, 1), accepted);
    EXPECT_EQ(c.look(), (Seen{refused, 0, static_cast<int>(Reason::line_down)}));
}

TEST(ParameterChannel, ResultsAreIgnoredUnlessBusy) {
    ParameterChannel channel;
    Result r;
    r.outcome = Outcome::refused;
    channel.finish(r, nullptr);
    EXPECT_EQ(channel.state(), ParameterChannel::State::idle);
}

}  // namespace
}  // namespace axisgate::modbus
