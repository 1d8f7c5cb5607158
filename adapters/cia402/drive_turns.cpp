// A node whose PDOs cannot be moved in a few attempts is reported and left as it is.
#include "adapters/cia402/drive_turns.hpp"

#include <fmt/core.h>

#include "adapters/cia402/drive_axis.hpp"

namespace axisgate::cia402_drive {
namespace {
int within(std::int64_t beat, int turns) { return static_cast<int>((beat % turns + turns) % turns); }
}  // namespace

void PdoTurns::set_up(int turns) noexcept {
    act_ = Act::rest;
    for (Reported& p : reported_) {
        p = {};
        p.turns = turns;
    }
}

void PdoTurns::came(std::size_t which, Turn& t) {
    Reported& p = reported_[which];
    const Line& line = drive_.node.line;
    if (p.turns != line.plan.turns || p.turns == 1 || (act_ != Act::rest && at_ == which)) return;
    const int error = within(static_cast<std::int64_t>(line.beat) - drive_.node.slot, p.turns);
    if (error == 0) {
        p.missed = 0;
        if (p.tries <= most_tries && ++p.in_place >= settled) p.tries = 0;
        return;
    }
    p.in_place = 0;
    p.missed = error == p.error ? p.missed + 1 : 1;
    p.error = error;
    if (p.missed >= sure && p.tries == most_tries) give_up(p, "they come beside it however they are set", t);
}
bool PdoTurns::misplaced(const Reported& p) const noexcept {
    return p.tries <= most_tries && (p.turns != drive_.node.line.plan.turns || (p.missed >= sure && p.tries < most_tries));
}
void PdoTurns::give_up(Reported& p, std::string_view why, Turn& t) {
    p.tries = most_tries + 1;
    act_ = Act::rest;
    drive_.node.notices.tell(
        Severity::warning, drive_.id(), "turns", p.error,
        fmt::format("{}: its PDOs keep to no turn: {}. The bus carries them in beats of other drives", drive_.node.setup.name, why), t.now,
        t.out);
}

std::size_t PdoTurns::first_misplaced() const noexcept {
    const std::size_t count = drive_.known.pdos.reports.size();
    std::size_t i = 0;
    while (i < count && !misplaced(reported_[i]))
        ++i;
    return i;
}

bool PdoTurns::wants(Instant now) const noexcept {
    const AxisKnown& known = drive_.known;
    if (!known.profile || known.polled) return false;
    if (act_ == Act::rest) return first_misplaced() < known.pdos.reports.size();
    return act_ != Act::on || drive_.node.line.in_turn(reported_[at_].wanted_slot, now);
}

Step PdoTurns::next() {
    const Line& line = drive_.node.line;
    if (act_ == Act::rest) {
        at_ = first_misplaced();
        Reported& p = reported_[at_];
        const bool same = p.turns == line.plan.turns;
        const int slot = drive_.node.slot, wanted = p.wanted_slot < 0 ? slot : p.wanted_slot;
        p.wanted_slot = same ? within(wanted - p.error, p.turns) : slot;
        p.tries = same ? p.tries + 1 : 0;
        act_ = Act::off;
    }
    const canopen::Pdo& pdo = drive_.known.pdos.reports[at_];
    auto settings = pdo.settings;
    settings.valid = act_ == Act::on;
    const std::uint16_t index = canopen::settings_index(pdo.direction, pdo.number);
    if (act_ == Act::type) return {Step::Kind::write, {index, 2}, bytes_of(line.plan.turns, 1)};
    return {Step::Kind::write, {index, 1}, bytes_of(canopen::id_word(settings), 4)};
}

void PdoTurns::answered(bool done, Turn& t) {
    if (act_ == Act::rest) return;
    Reported& p = reported_[at_];
    if (!done) return give_up(p, "the drive refuses to have them set", t);
    if (act_ == Act::type) p.turns = drive_.node.line.plan.turns;
    if (act_ != Act::on) return void(act_ = act_ == Act::off ? Act::type : Act::on);
    act_ = Act::rest;
    p.missed = 0;
    drive_.feedback.begin(t.now);  // the PDOs have paused
}

}  // namespace axisgate::cia402_drive
