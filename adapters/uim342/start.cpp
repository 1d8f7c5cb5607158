// Start: the list that is read, and what each answer leads to.
// In: answers of the drive. Out: the next read; presence, identity, what a restart has lost.
// Never asks for ever: what two tries do not get stays unknown.
#include "adapters/uim342/start.hpp"

#include <fmt/core.h>

#include "adapters/uim342/drive.hpp"
#include "adapters/uim342/native.hpp"

namespace axisgate::uim342 {
namespace {
struct Read {
    std::uint8_t cw;
    std::uint8_t index;
};
// First what every command rests on; commands wait for it. Then the rest of the picture, between polls and behind commands.
constexpr std::array core{Read{cw::MS, 0}, Read{cw::MS, 1}, Read{cw::ER, 0}, Read{cw::IC, 4}, Read{cw::IC, 0}, Read{cw::IC, 5},
                          Read{cw::AC, 0}, Read{cw::DC, 0}, Read{cw::SS, 0}, Read{cw::SD, 0}, Read{cw::DV, 0}, Read{cw::DV, 2},
                          Read{cw::PP, 7}, Read{cw::PP, 8}, Read{cw::QE, 3}, Read{cw::IE, 8}};
constexpr std::array rest{
    Read{cw::SN, 0}, Read{cw::PP, 5}, Read{cw::IC, 1}, Read{cw::IC, 2}, Read{cw::IC, 3}, Read{cw::IC, 6}, Read{cw::IC, 7}, Read{cw::MT, 0},
    Read{cw::MT, 1}, Read{cw::MT, 2}, Read{cw::MT, 3}, Read{cw::QE, 0}, Read{cw::QE, 1}, Read{cw::QE, 2}, Read{cw::QE, 4}, Read{cw::IE, 0},
    Read{cw::IE, 1}, Read{cw::IE, 2}, Read{cw::DV, 1}, Read{cw::DV, 3}, Read{cw::DV, 4}, Read{cw::BL, 0}, Read{cw::IL, 0}, Read{cw::IL, 1},
    Read{cw::IL, 2}, Read{cw::IL, 3}, Read{cw::TG, 0}, Read{cw::TG, 1}, Read{cw::TG, 2}, Read{cw::DI, 0}, Read{cw::MO, 0}};
constexpr std::size_t all = core.size() + rest.size();
constexpr Duration boot_time = std::chrono::milliseconds(300);  // not in the manual; probing goes on if it takes longer

constexpr Read read_at(std::size_t n) { return n < core.size() ? core[n] : rest[n - core.size()]; }
}  // namespace

void Start::begin(Turn& t) {
    drive_.presence.begin(t.now);
    drive_.polls.stop();
}

void Start::probe(Turn& t) {
    drive_.presence.probe_sent();
    drive_.exchanges.send({drive_.get(cw::ML), Purpose::probe}, 0, Priority::poll, t);
}

void Start::lost(Turn& t, std::string why) {
    const Feedback& feedback = drive_.feedback;
    before_ = {feedback.status_known() && feedback.position_known(), feedback.status().on, feedback.fb().referenced, feedback.fb().position,
               drive_.errors.ours()};
    drive_.polls.stop();
    drive_.fail_all(Reason::no_answer, why, t);
    drive_.presence.report(std::move(why), t.out);
}

/// Whoever refuses ML is no UIM342 as the manual has it, or not ready: what waits is answered now, and it is asked again.
void Start::probe_refused(Turn& t) {
    drive_.presence.lose(t.now, drive_.bus.timing.pause_max);
    lost(t, fmt::format("ID {} refuses to tell its model", drive_.address()));
}

void Start::probe_answered(const Message& m, Turn& t) {
    const Model model = model_of(m);
    if (model.gateway) {
        drive_.presence.lose(t.now, drive_.bus.timing.pause_max);
        return lost(
            t, fmt::format("at ID {} answers a gateway ({}), not a UIM342: correct the drive's address", drive_.address(), model.name));
    }
    const unsigned firmware = m.dl >= 6 ? get_u16(&m.d[4]) : 0u;
    identity_ = fmt::format("{}, firmware {}", model.name, firmware);
    if (model.name.empty()) {
        identity_ = fmt::format("unknown model ({}), firmware {}", hex_of(m), firmware);
        drive_.notice(
            Severity::warning, "model", 0,
            fmt::format("ID {} answers ML with {}: not a model of the UIM342 manual; it is treated as one", drive_.address(), hex_of(m)),
            t);
    }
    drive_.presence.found();
    drive_.presence.report(identity_, t.out);
    drive_.publish(m, 0, t);
    drive_.errors.found(before_.known && before_.own_error);
    drive_.feedback.found();
    drive_.stops.ramp_over();
    drive_.demand.forget();
    drive_.together.unprepare();
    read_all();
}

void Start::read_again() {
    if (reading_.pending()) return;
    reading_.begin(core.size(), all);
    drive_.exchanges.mf_unknown = true;
    drive_.known.ram = {};
}

void Start::read_all() {
    reading_.begin(core.size(), all);
    drive_.exchanges.mf_unknown = true;
    drive_.known.forget();
}

void Start::read_next(Turn& t) {
    const Read r = read_at(reading_.at());
    const Message m = drive_.get(r.cw, r.index);
    if (drive_.exchanges.makes_way(m, 0, Priority::poll, t)) return;
    if (!reading_.given_up()) return drive_.exchanges.send({m, Purpose::startup}, drive_.bus.timing.retries, Priority::poll, t);
    // Everything else is answered but not this one: leave it unknown rather than ask for ever.
    drive_.notice(Severity::warning, "protocol", 0, fmt::format("{} is not answered; its value stays unknown", describe_request(m)), t);
    step_done(t);
    if (reading_.pending() && drive_.presence.is(drive::Presence::Phase::starting)) read_next(t);
}

void Start::step_done(Turn& t) {
    if (reading_.done()) core_known(t);
}

/// Everything is known that commands rest on.
void Start::core_known(Turn& t) {
    const bool first = drive_.presence.is(drive::Presence::Phase::starting);
    const Known& known = drive_.known;
    Feedback& feedback = drive_.feedback;
    drive_.presence.made_ready();
    if (first) {
        // A restart loses the zero of an incremental encoder. A drive that is still on (and does not switch itself on), or still
        // stands where it stood (a restart begins at 0), was only out of reach.
        const bool stayed_on = before_.on && feedback.status().on && known.auto_on == false;
        const bool stayed_there = before_.position != 0 && feedback.fb().position == before_.position && known.absolute_encoder == false;
        const bool same = before_.known && feedback.position_known() && (stayed_on || stayed_there);
        same&& before_.referenced ? feedback.zero_known() : feedback.zero_lost();
        if (before_.known && !same) {
            drive_.notice(Severity::info, "presence", 0,
                          "the drive was away and may have been restarted: values kept in RAM alone are lost", t);
        }
        before_ = {};
        feedback.power_as_found();
        drive_.polls.begin(t.now);
    }
    if (drive_.options.absolute_known && known.absolute_encoder == true && known.battery_ok != false) feedback.zero_known();
    feedback.update(t);
}

void Start::reboot_begun(Ticket waits, Turn& t) {
    before_ = {};
    drive_.feedback.zero_lost();
    drive_.fail_all(Reason::interrupted, "the drive is restarted", t);
    reboot_ = waits;
    drive_.homing.nothing_to_put_back();
    drive_.presence.restart(t.now, boot_time);
    drive_.polls.stop();
}

void Start::back(Turn& t) { drive_.tickets.answer(std::exchange(reboot_, no_ticket), Outcome::done, Reason::none, "", t.out); }

void Start::not_back(Reason reason, const std::string& text, Turn& t) {
    drive_.tickets.failed(std::exchange(reboot_, no_ticket), reason, text, t.out);
}

}  // namespace axisgate::uim342
