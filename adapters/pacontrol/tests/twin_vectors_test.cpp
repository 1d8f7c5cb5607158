// Twin against the golden messages: every case of vectors.txt that is not for the wire alone is played, byte for byte.
// In: adapters/pacontrol/vectors.txt. Out: nothing; the forms are told at the head of that file.
#include <fstream>

#include "adapters/pacontrol/tests/twin_bench.hpp"

namespace axisgate::pacontrol::twin::test {
namespace {

struct Line {
    std::string keyword, rest;
    int number = 0;
};

struct Case {
    std::string name;
    bool wire = false;
    std::vector<Line> lines;
};

std::vector<Case> cases() {
    std::ifstream in(AXISGATE_SOURCE_DIR "/adapters/pacontrol/vectors.txt");
    std::vector<Case> all;
    std::string text;
    for (int number = 1; std::getline(in, text); ++number) {
        if (text.empty() || text[0] == '#') continue;
        const auto end = text.find(' ');
        Line line{text.substr(0, end), end == std::string::npos ? "" : text.substr(text.find_first_not_of(' ', end)), number};
        if (line.keyword == "case") {
            all.push_back({line.rest.substr(0, line.rest.find(' ')), false, {}});
        } else if (line.keyword == "wire") {
            all.back().wire = true;
        } else if (!all.empty()) {
            all.back().lines.push_back(line);
        }
    }
    return all;
}

/// Fields of a text.
std::vector<std::string> split(const std::string& text) {
    std::vector<std::string> parts;
    std::istringstream in(text);
    std::string part;
    while (std::getline(in, part, ';'))
        parts.push_back(part);
    return parts;
}

class Player {
public:
    void play(const Case& c) {
        SCOPED_TRACE(c.name);
        // What a control has before its power on.
        NonVolatile memory;
        std::map<std::string, std::string> options;
        for (const Line& l : c.lines) {
            if (l.keyword != "state") continue;
            std::istringstream in(l.rest);
            std::string name, value;
            in >> name >> value;
            if (name == "axis2.position") memory["axis2.position"] = memory["axis2.shaft"] = std::stod(value);
            if (name == "axis1.referenced" && value == "0") options["absolute"] = "off";
            if (name == "rotary") options["rotary"] = value;
        }
        bench_ = std::make_unique<Bench>(setup(4, options), memory);
        // Everything else is set by the hand and by commands in home position, the mode last.
        for (const bool mode : {false, true}) {
            for (const Line& l : c.lines)
                if (l.keyword == "state") state(l.rest, mode);
        }
        bench_->raw.clear();
        for (std::size_t i = 0; i < c.lines.size(); ++i) {
            const Line& l = c.lines[i];
            SCOPED_TRACE("line " + std::to_string(l.number));
            const bool bytes_follow = i + 1 < c.lines.size() && c.lines[i + 1].keyword == "bytes";
            if (l.keyword == ">") {
                const Bytes sent = bytes_follow ? hex(c.lines[i + 1].rest) : frame(l.rest);
                if (bytes_follow) EXPECT_EQ(sent, frame(l.rest)) << "the vector's own check";
                reported_ = exchange(sent);
            } else if (l.keyword == "wait") {
                bench_->pass(std::chrono::milliseconds(std::stoi(l.rest)));
            } else if (l.keyword == "poll>") {
                reported_ = exchange({4});
            } else if (l.keyword == "<" || l.keyword == "<~") {
                compare(l.rest, l.keyword == "<~");
                if (bytes_follow && l.keyword == "<") EXPECT_EQ(bench_->raw.back(), hex(c.lines[i + 1].rest));
            }
        }
    }

private:
    void state(const std::string& text, bool mode) {
        std::istringstream in(text);
        std::string name, value;
        in >> name >> value;
        if (name == "mode") {
            if (mode && value == "online") bench_->online();
            if (mode && value == "automatic") bench_->good("0602;0;0;0");
            return;
        }
        if (mode) return;
        const auto numbered = [&](std::size_t skip) { return name.substr(skip); };
        if (name == "rotary") {
            return;  // a matter of its making
        } else if (name == "external_stop") {
            bench_->hand(name, value != "0");
        } else if (name == "error") {
            bench_->hand("inject_error", std::int64_t{std::stoi(value)});
        } else if (name.starts_with("axis")) {
            return;  // done before
        } else if (name.starts_with("IW")) {
            const int first = (std::stoi(numbered(2)) - 1) * 16;
            for (int b = 0; b < 16; ++b)
                bench_->hand("I" + std::to_string(first + b + 1), ((std::stoi(value) >> b) & 1) != 0);
            bench_->good("0700;4;0;0");  // the stop input, which the contact feeds, lies in that word
        } else if (name.starts_with("OW")) {
            bench_->good("0903;" + std::to_string(std::stoi(numbered(2)) * 16) + ";0;" + value);
        } else if (name.starts_with("MW")) {
            bench_->good("0905;" + std::to_string(std::stoi(numbered(2)) * 16) + ";0;" + value);
        } else if (name.starts_with("SP")) {
            bench_->good("0700;" + numbered(2) + ";0;" + value);
        } else if (name.starts_with("AP")) {
            bench_->good("0800;" + numbered(2) + ";1;" + value);
        } else if (name.starts_with("I")) {
            bench_->hand(name, value != "0");
        } else if (name.starts_with("O")) {
            bench_->good("0902;" + numbered(1) + ";0;" + value);
        } else if (name.starts_with("M")) {
            bench_->good("0904;" + numbered(1) + ";0;" + value);
        } else if (name.starts_with("N")) {
            bench_->good("0906;" + numbered(1) + ";0;" + value);
        } else if (name.starts_with("R")) {
            bench_->good("0907;" + numbered(1) + ";1;" + value);
        } else {
            ADD_FAILURE() << "unknown state " << name;
        }
    }

    std::string exchange(const Bytes& sent) {
        auto texts = bench_->bytes(sent);
        if (!texts.empty()) return bench_->one(texts, "exchange");
        const std::size_t before = bench_->raw.size();
        bench_->pass(10ms);
        EXPECT_EQ(bench_->raw.size(), before + 1);
        if (bench_->raw.size() == before) return "";
        const Bytes& b = bench_->raw.back();
        return {b.begin() + 2, std::find(b.begin(), b.end(), 3)};
    }

    void compare(const std::string& wanted, bool free) {
        if (!free) {
            EXPECT_EQ(reported_, wanted);
            return;
        }
        const auto want = split(wanted), got = split(reported_);
        ASSERT_EQ(want.size(), got.size()) << reported_;
        for (std::size_t i = 0; i < want.size(); ++i)
            if (want[i] != "xx") EXPECT_EQ(got[i], want[i]) << "field " << i + 1 << " of " << reported_;
    }

    std::unique_ptr<Bench> bench_;
    std::string reported_;
};

TEST(TwinVectors, EveryCase) {
    const auto all = cases();
    int played = 0;
    for (const Case& c : all) {
        const bool serial = std::ranges::any_of(c.lines, [](const Line& l) { return l.keyword == ">"; });
        if (c.wire || !serial) continue;
        Player().play(c);
        ++played;
    }
    EXPECT_GE(played, 55) << "of " << all.size();
}

}  // namespace
}  // namespace axisgate::pacontrol::twin::test
