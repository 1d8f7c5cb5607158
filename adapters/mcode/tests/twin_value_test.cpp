// Arithmetic of the twin against a small evaluator of the test's own; tokens; bounds of the editor with random text.
// In: random programs from fixed seeds. Out: equal results.
// Never uses the twin's own operators for the expected value.
#include <random>

#include "adapters/mcode/tests/twin_bench.hpp"

namespace axisgate::mcode::twin::test {
namespace {

/// Left to right on 64-bit integers, quotient cut toward zero; nothing where the drive must refuse.
std::optional<std::int32_t> expected(const std::vector<std::int64_t>& operands, const std::string& signs) {
    std::int64_t v = operands[0];  // four factors of 10000 at most
    for (std::size_t i = 0; i < signs.size(); ++i) {
        const std::int64_t b = operands[i + 1];
        switch (signs[i]) {
            case '+':
                v += b;
                break;
            case '-':
                v -= b;
                break;
            case '*':
                v *= b;
                break;
            case '/':
                if (b == 0) return std::nullopt;
                v /= b;
                break;
            case '&':
                v = static_cast<std::int32_t>(v) & static_cast<std::int32_t>(b);
                break;
            case '|':
                v = static_cast<std::int32_t>(v) | static_cast<std::int32_t>(b);
                break;
            default:
                v = static_cast<std::int32_t>(v) ^ static_cast<std::int32_t>(b);
                break;
        }
    }
    if (v > 2147483647 || v < -2147483648LL) return std::nullopt;
    return static_cast<std::int32_t>(v);
}

TEST(TwinValue, RandomExpressionsLikeTheReference) {
    std::mt19937 random(20160501);
    Bench b;
    b.type("VA Q1");
    int refused = 0;
    for (int round = 0; round < 2000; ++round) {
        const auto number = [&] { return static_cast<std::int64_t>(random() % 20001) - 10000; };
        const std::int64_t q = number(), r2 = number();
        b.type("Q1=" + std::to_string(q));
        b.type("R2=" + std::to_string(r2));
        std::string line = "R1=", signs;
        std::vector<std::int64_t> operands;
        const int count = 1 + static_cast<int>(random() % 4);
        for (int i = 0; i < count; ++i) {
            if (i > 0) {
                signs += "+-*/&|^"[random() % 7];
                line += signs.back();
            }
            switch (random() % 4) {
                case 0:
                    operands.push_back(q);
                    line += "Q1";
                    break;
                case 1:
                    operands.push_back(-r2);
                    line += "-R2";
                    break;
                case 2:
                    operands.push_back(~r2);
                    line += "!R2";
                    break;
                default:
                    operands.push_back(number());
                    line += std::to_string(operands.back());
                    break;
            }
        }
        const auto want = expected(operands, signs);
        b.type("R1=123456");
        b.type(line);
        const int code = std::stoi(b.type("PR ER"));
        EXPECT_EQ(code, want ? 0 : 21) << line << " Q1=" << q << " R2=" << r2;
        EXPECT_EQ(b.type("PR R1"), std::to_string(want.value_or(123456))) << line << " Q1=" << q << " R2=" << r2;
        if (!want) ++refused;
    }
    EXPECT_GT(refused, 20);
    EXPECT_LT(refused, 1000);
}

TEST(TwinValue, RandomLoopsLikeTheReference) {
    std::mt19937 random(7);
    for (int round = 0; round < 50; ++round) {
        const int limit = 1 + static_cast<int>(random() % 20), step = 1 + static_cast<int>(random() % 5),
                  mask = static_cast<int>(random() % 16);
        Bench b;
        std::int32_t r1 = 0, r2 = 0, r3 = 0;
        do {
            r1 += step;
            r2 = r2 * 3 + r1;
            r2 &= 0xFFFF;
            if ((r1 & mask) != 0) ++r3;
        } while (r1 < limit);
        b.run({"LB G1", "R1=R1+" + std::to_string(step), "R2=R2*3+R1", "R2=R2&65535", "BR G2,R1&" + std::to_string(mask), "BR G3", "LB G2",
               "IC R3", "LB G3", "BR G1,R1<" + std::to_string(limit), "E"});
        EXPECT_EQ(b.type("PR R1,\",\",R2,\",\",R3"), std::to_string(r1) + "," + std::to_string(r2) + "," + std::to_string(r3)) << round;
    }
}

TEST(TwinValue, RandomTextNeverBreaksTheDrive) {
    std::mt19937 random(99);
    const std::string letters = "ABCEFHILMPQRSTVX0123456789=,\"'+-*/&|^!<> ._;$\\~";
    Bench b;
    for (int round = 0; round < 5000; ++round) {
        std::string line;
        const std::size_t size = random() % 24;
        for (std::size_t i = 0; i < size; ++i)
            line += letters[random() % letters.size()];
        b.send(line + "\r");
        if (round % 50 == 0) b.send("\x1B");
    }
    b.send("\x03");
    b.send("\r");
    EXPECT_EQ(b.type("PR BY"), "0");
}

TEST(TwinValue, TokensOfALine) {
    const Tokens t("Tp = 51200 , Kb 'comment \"x\"");
    EXPECT_EQ(t.peek(0).text, "Tp");
    EXPECT_EQ(t.peek(1).sign, '=');
    EXPECT_EQ(t.peek(2).number.i, 51200);
    EXPECT_EQ(t.peek(3).sign, ',');
    EXPECT_EQ(t.peek(4).text, "Kb");
    EXPECT_EQ(t.peek(5).kind, Token::Kind::end);
    EXPECT_EQ(Tokens("=<").peek().sign, 'l');
    EXPECT_EQ(Tokens("<=").peek().sign, 'l');
    EXPECT_EQ(Tokens("<>").peek().sign, 'n');
    EXPECT_EQ(Tokens("1.5e3").peek().number.d, 1500.0);
    EXPECT_EQ(Tokens("\"open").peek().kind, Token::Kind::other);
    EXPECT_EQ(Tokens(std::string(200, '-')).peek(63).sign, '-');
    EXPECT_EQ(Tokens(std::string(200, '-')).peek(64).kind, Token::Kind::end);
}

}  // namespace
}  // namespace axisgate::mcode::twin::test
