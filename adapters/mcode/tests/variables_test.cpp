// User variables as parameters: the drive's option, its own catalogue, what the drive's listing says of both.
// In: options, embedded drives on a line with honest wire time. Out: parameters, values, notices, refusals in words.
#include "adapters/mcode/parameters_variables.hpp"

#include "adapters/mcode/tests/line_bench.hpp"

namespace axisgate::mcode::test {
namespace {

OwnCatalogue made(const std::string& names) {
    const std::map<std::string, std::string> options{{"variables", names}};
    return own_catalogue({catalogue(), options});
}

TEST(McodeVariables, TheOptionMakesParametersBehindThoseOfTheFamily) {
    EXPECT_EQ(own_catalogue({catalogue(), {}}).catalogue, nullptr);
    EXPECT_EQ(made(" ").catalogue, nullptr);
    const auto own = made("q1, K2:mm,Z");
    ASSERT_TRUE(own.catalogue) << own.fault;
    ASSERT_EQ(own.catalogue->parameters().size(), catalogue().parameters().size() + 3);
    const auto point = own.catalogue->find("UV.K2");
    ASSERT_TRUE(point);
    EXPECT_EQ(point->parameter, catalogue().parameters().size() + 1);
    EXPECT_EQ(own.catalogue->find("uv_k2"), point);
    const Parameter& p = *own.catalogue->parameter(*point);
    EXPECT_EQ(p.unit, "mm");
    EXPECT_EQ(p.type, ValueType::i32);
    EXPECT_TRUE(p.live) << "a variable of a program: a snapshot keeps it, and writes it back when it is asked to";
    EXPECT_EQ(own.catalogue->check_write(*point, Value{std::int64_t{2147483648}}).value, Value{});
    EXPECT_EQ(own.catalogue->find("VM"), catalogue().find("VM"));
    for (const auto& [names, why] : {std::pair{"Q1,Q1", "there twice"},
                                     {"VM", "VM is no user variable"},
                                     {"Q1,,Q2", "nothing is no user variable"},
                                     {"Q12", "Q12 is no user variable"},
                                     {"1Q", "1Q is no user variable"},
                                     {"Q1:", "its unit"}}) {
        const auto bad = made(names);
        EXPECT_EQ(bad.catalogue, nullptr) << names;
        EXPECT_NE(bad.fault.find(why), std::string::npos) << bad.fault;
    }
    std::string many;
    for (char a = 'G'; a <= 'Z'; ++a)
        for (char b = '0'; b <= '9'; ++b)
            if (!(a == 'I' || a == 'O' || a == 'R')) many += std::string(many.empty() ? "" : ",") + a + b;
    EXPECT_TRUE(made(many).catalogue) << made(many).fault;
    for (const char* more : {"A0", "A1"})  // letters of A to F may be words: T and others too, so a few are enough
        EXPECT_EQ(made(std::string("Q1,") + more).fault, "");
}

TEST(McodeVariables, ListingsAreReadAsTheDrivePrintsThem) {
    constexpr std::string_view rows = "Q1 = G 25\r\nK2 = L -3\r\nZ = G 0\r\n";
    EXPECT_EQ(global_variables(rows), (std::vector<std::string>{"Q1", "Z"}));
    EXPECT_EQ(listed_variables(rows), (std::vector<std::string>{"Q1", "K2", "Z"}));
    EXPECT_TRUE(listed_variables("\r\n").empty());
}

struct VariableBench : LineBench {
    explicit VariableBench(const std::string& names, std::uint32_t rate = 9600) : LineBench("a", rate) {
        setup.drives[0].options["variables"] = names;
        setup.drives[0].catalogue = made(names).catalogue;
    }
    void up() {
        adapter.configure(setup, now, out);
        drain();
        run(setup.bit_rate < 9600 ? 30s : 4s);
        ASSERT_TRUE(online());
    }
    [[nodiscard]] Point point(std::string_view id) const { return *setup.drives[0].catalogue->find(id); }
    [[nodiscard]] std::vector<std::string> reported() const {
        std::vector<std::string> list;
        for (const auto& n : notices)
            if (n.kind == "variables") list.push_back(n.text);
        return list;
    }
    Result native(std::string_view s) { return wait(Native{{s.begin(), s.end()}, true}); }
};

TEST(McodeVariables, AreReadAndWrittenAsTheDrivesOwn) {
    VariableBench b("Q1:mm,K2");
    b.up();
    ASSERT_TRUE(good(b.native("VA Q1=-25")));
    ASSERT_TRUE(good(b.native("VA K2")));
    Result r = b.wait(ReadParameter{b.point("UV.Q1")});
    EXPECT_EQ(r.value, Value{std::int64_t{-25}}) << r.text;
    r = b.wait(WriteParameter{b.point("UV.K2"), Value{std::int64_t{2147483647}}});
    EXPECT_EQ(r.outcome, Outcome::done) << r.text;
    EXPECT_EQ(r.value, Value{std::int64_t{2147483647}}) << "read back";
    EXPECT_EQ(b.wait(ReadParameter{*catalogue().find("VM")}).outcome, Outcome::done) << "points of the page stay";
}

TEST(McodeVariables, OneThatTheDriveLacksIsRefusedWithASentence) {
    VariableBench b("Q1,K2");
    b.up();
    ASSERT_EQ(b.reported().size(), 1u);
    EXPECT_NE(b.reported()[0].find("Q1, K2"), std::string::npos) << b.reported()[0];
    for (const CommandBody& body :
         {CommandBody{ReadParameter{b.point("UV.Q1")}}, CommandBody{WriteParameter{b.point("UV.Q1"), Value{std::int64_t{1}}}}}) {
        const Result r = b.wait(body);
        EXPECT_EQ(r.outcome, Outcome::refused);
        EXPECT_NE(r.text.find("has no user variable Q1 now: declare it"), std::string::npos) << r.text;
    }
    b.notices.clear();
    ASSERT_TRUE(good(b.native("VA Q1=4")));
    EXPECT_EQ(b.wait(ReadParameter{b.point("UV.Q1")}).value, Value{std::int64_t{4}}) << "from then on it is there";
}

TEST(McodeVariables, WhatTheSiteDoesNotNameIsTold) {
    for (const std::uint32_t rate : {1200u, 9600u, 115200u}) {
        VariableBench b("Q1", rate);
        b.up();
        ASSERT_TRUE(good(b.native("VA Q1=1")));
        ASSERT_TRUE(good(b.native("VA K2=2")));
        ASSERT_TRUE(good(b.native("S")));
        b.run(3s);
        b.notices.clear();
        b.hand(0, "power", Value{false});
        b.run(10s);
        b.hand(0, "power", Value{true});
        b.run(40s);
        ASSERT_TRUE(b.online());
        ASSERT_EQ(b.reported().size(), 1u) << rate;
        EXPECT_NE(b.reported()[0].find("no parameters of its axis: K2;"), std::string::npos) << b.reported()[0];
        const Result r = b.wait(Action{"UV", ""});
        EXPECT_NE(to_text(r.value).find("K2 = G 2"), std::string::npos) << to_text(r.value);
    }
}

}  // namespace
}  // namespace axisgate::mcode::test
