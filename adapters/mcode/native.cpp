// NativeLines and PlainActions: what they send, and when the drive must stand first.
// In: texts. Out: steps, refusals.
// Never repeats a line that nobody knows the effect of.
#include "adapters/mcode/native.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <utility>

#include "adapters/mcode/drive.hpp"

namespace axisgate::mcode {

void NativeLines::plan(const Command& c, Turn& t) {
    const Native& native = std::get<Native>(c.body);
    std::string line(native.send.begin(), native.send.end());
    // Bytes are the same line, with its end or without: the end, the name and the checksum are the line's own business.
    if (!native.is_text && line.ends_with('\n')) line.pop_back();
    if (!native.is_text && line.ends_with('\r')) line.pop_back();
    if (auto why = check_line(line); !why.empty()) return refuse(Reason::out_of_range, why, t);
    const std::string w = word_of(line);
    if (w.starts_with("PG") && w.find_first_not_of("0123456789", 2) == std::string::npos)  // PG1 means PG 1 [L7052]
        return refuse(Reason::not_supported, "PG would take the polls into the program: use the action program.download", t);
    const bool sets = line.find('=') != std::string::npos;
    if (sets && is_link_word(w)) {
        return refuse(Reason::not_supported, fmt::format("{} belongs to the line: set it with the line's options, or with line.setup", w),
                      t);
    }
    if (sets && w == "CE") drive_.words.ce = 1;  // until it is read: perhaps
    w == "PR" || w == "L" ? job().list(line) : job().send(line, false);
}

namespace {
struct Named {
    std::string_view name, line;
    bool repeatable = true;
};
constexpr std::array named_lines{Named{"program.pause", "PS"},     Named{"program.resume", "RS"}, Named{"program.end", "E"},
                                 Named{"program.save", "S"},       Named{"restore", "IP"},        Named{"clear_locked_rotor", "CF"},
                                 Named{"calibrate", "SC 1", false}};
}  // namespace

void PlainActions::plan(const Command& c, Turn& t) {
    const Action& a = std::get<Action>(c.body);
    std::string line;
    bool repeatable = true;
    const auto with_argument = [&](std::string_view word) {
        return a.argument.empty() ? std::string(word) : fmt::format("{} {}", word, a.argument);
    };
    if (const auto n = std::ranges::find(named_lines, a.name, &Named::name); n != named_lines.end()) {
        line = n->line;
        repeatable = n->repeatable;
    } else if (a.name == "program.list") {
        line = with_argument("L");
    } else if (a.name == "program.start") {
        line = fmt::format("EX {}", a.argument.empty() ? "1" : a.argument);
        repeatable = false;
    } else if (a.name == "program.clear") {
        if (a.argument.empty()) drive_.programs.untidy();
        line = with_argument("CP");
    } else if (a.name == "AL" || a.name == "UV") {
        line = "PR " + a.name;  // keywords of PR
    } else {
        constexpr std::array<std::string_view, 5> others{"PG", "PR", "L", "FD", "UG"};
        const std::string w = word_of(a.name);
        const bool known = w == a.name && std::ranges::find(others, w) == others.end() &&
                           std::ranges::any_of(drive_.bus.catalogue.commands(), [&](const CatalogueCommand& k) { return k.id == w; });
        if (!known) return refuse(Reason::unknown_point, fmt::format("there is no action {}; see the family's commands", a.name), t);
        line = with_argument(w);
        repeatable = false;
        if (auto why = check_line(line); !why.empty()) return refuse(Reason::out_of_range, why, t);
    }
    if (auto why = check_line(line); !why.empty()) return refuse(Reason::out_of_range, fmt::format("{}: {}", a.name, why), t);
    const std::string w = word_of(line);
    if (w == "L" || w == "PR") {
        job().list(std::move(line));
        return;
    }
    // Refused by the drive while MV is 1, which a finished move leaves behind; what really moves is the drive's to refuse.
    const bool at_rest = w == "S" || w == "CP" || w == "IP" || w == "SC";
    if (at_rest && feedback().flags().mv && !feedback().goes()) (void)wait_for_rest(t);
    job().send(std::move(line), repeatable);
}

/// A started program has begun. Its end is another matter, for who waits for it.
void PlainActions::done(Turn& t) {
    const bool begun = std::get<Action>(job().command.body).name == "program.start";
    if (!begun) return succeed(job().text, t);
    if (!job().command.until_done) return accept(job().text, t);
    drive_.program.await(drive_.jobs.hand_over().command, t);
    drive_.poll.soon(t.now);
}

}  // namespace axisgate::mcode
