// Walk: tables of statements and what the reference says of them, played against a whole drive, motor included.
// In: rows of a line and what it must give. Out: failures that name the row.
// Never looks inside the drive.
#pragma once

#include "adapters/mcode/tests/twin_wire.hpp"

namespace axisgate::mcode::twin::test {

/// `line` is typed in single mode, EM = 0; or, by its first character:
///   @name value   the tester's hand (a number; `stall`, `enable_input` and switches take 0 or 1)
///   ~ms           time passes; `want` is what comes meanwhile, `*` anything
///   $1B           bytes as they are, hexadecimal
/// `want`: "" accepted and no data; `!21` refused with this code; `*` accepted with any data; `?` anything at all; `~lo..hi` a number in
/// this range; else the data, where `|` stands for CR LF.
struct Row {
    const char* line;
    std::string want;
};

struct Walk {
    const char* topic;
    std::vector<Row> rows;
    std::uint8_t product = lmdc;
    int frame_size = 23;
    bool ethernet = false;
};

/// `spoken`: what came at the hand's last touch belongs to the wait behind it.
inline void play_row(Wire& w, const Row& r, bool& spoken) {
    SCOPED_TRACE(std::string(r.line) + "  wants  " + r.want);
    const std::string line = r.line;
    if (line[0] == '@') {
        w.sent.clear();
        spoken = true;
        const auto gap = line.find(' ');
        const std::string name = line.substr(1, gap - 1);
        const double v = std::stod(line.substr(gap + 1));
        const bool flag = name == "stall" || name == "enable_input" || name.ends_with("_switch") || name == "limit_positive" ||
                          name == "power" || name == "limit_negative";
        const bool mask = name.ends_with("inputs") || name.ends_with("_fault");
        w.hand(name, flag ? Value{v != 0} : mask ? Value{static_cast<std::int64_t>(v)} : Value{v});
        w.pass(milliseconds(1));
        return;
    }
    const auto lines_of = [](std::string s) {
        for (std::size_t at = 0; (at = s.find("\r\n", at)) != std::string::npos;)
            s.replace(at, 2, "|");
        if (s.ends_with('|')) s.pop_back();
        return s;
    };
    if (line[0] == '~') {
        if (!spoken) w.sent.clear();
        spoken = false;
        w.pass(milliseconds(std::stoll(line.substr(1))));
        if (r.want != "*") EXPECT_EQ(lines_of(w.sent), r.want);
        return;
    }
    spoken = false;
    if (line[0] == '$') {
        std::string raw;
        for (std::size_t i = 1; i + 1 < line.size(); i += 2)
            raw += static_cast<char>(std::stoi(line.substr(i, 2), nullptr, 16));
        (void)w.bytes(raw);
        if (r.want != "*") EXPECT_EQ(lines_of(w.sent), r.want);
        return;
    }
    (void)w.bytes(line + "\r");
    std::string rest = w.sent;
    ASSERT_TRUE(rest.starts_with(line + "\r\n")) << shown(rest);
    rest.erase(0, line.size() + 2);
    ASSERT_FALSE(rest.empty());
    const auto is_prompt = [](char c) { return c == '>' || c == '?'; };
    char prompt = '\0';
    if (is_prompt(rest.back())) {
        prompt = rest.back();
        rest.pop_back();
    } else if (is_prompt(rest.front())) {
        prompt = rest.front();  // behind it a program speaks
        rest.erase(0, 1);
    }
    const std::string data = lines_of(rest);
    if (r.want == "?") return;
    if (r.want.size() > 1 && r.want[0] == '!') {
        EXPECT_EQ(prompt, '?');
        EXPECT_EQ(w.ask("PR ER"), r.want.substr(1));
        return;
    }
    // The prompt also shows what has gone wrong before, until ER is read; a line that fails gives no data.
    if (prompt != '>' && data.empty()) ADD_FAILURE() << "error " << w.ask("PR ER");
    if (r.want.starts_with('~')) {
        const auto dots = r.want.find("..");
        const double v = data.empty() ? 1e300 : std::atof(data.c_str());
        EXPECT_GE(v, std::stod(r.want.substr(1, dots - 1))) << data;
        EXPECT_LE(v, std::stod(r.want.substr(dots + 2))) << data;
    } else if (r.want != "*") {
        EXPECT_EQ(data, r.want);
    }
}

inline void play(const Walk& walk) {
    SCOPED_TRACE(walk.topic);
    Wire w(walk.product, '!', {}, walk.frame_size, walk.ethernet);
    bool spoken = false;
    for (const Row& r : walk.rows)
        play_row(w, r, spoken);
}

inline void play(const std::vector<Walk>& walks) {
    for (const Walk& walk : walks)
        play(walk);
}

}  // namespace axisgate::mcode::twin::test
