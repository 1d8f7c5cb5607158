// Start: probes until the drive is understood, its link as the site wants it, its values one after the other; silences until it is lost.
// In: the ends of exchanges. Out: the drive's presence. A drive with CK on ignores a line without checksum, one with CK off does not know
// the extra byte, so probes take turns with both.
// Never reads ER: that clears it, so it is asked when EF says that there is something to be told.
#include "adapters/mcode/start.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <utility>

#include "adapters/mcode/drive.hpp"

namespace axisgate::mcode {
using Phase = drive::Presence::Phase;
using What = Request::Purpose;

namespace {
/// What is refused is left unknown. VI stands for all values that moves take.
constexpr std::array<std::string_view, 8> first_questions{"PN", "VR", "BY", "AS", "ST", "VI", "IF", "BD"};
constexpr std::array<std::pair<int, std::uint32_t>, 5> rates{{{48, 4800}, {96, 9600}, {19, 19200}, {38, 38400}, {11, 115200}}};
}  // namespace

// --- presence --------------------------------------------------------------------------------------------------------------------

void Start::probe_anew(Turn& t) {
    drive_.presence.begin(t.now);
    drive_.poll.stop();
    drive_.errors.stop_asking();
    drive_.words.sums = false;
    drive_.words.em = 1;
    drive_.trailing.forget();
    pause_ = {};
    link_rounds_ = spoiled_ = 0;
    link_line_.clear();
    unproven_.clear();
}

void Start::again(Turn& t) noexcept { drive_.presence.received(t.now); }

void Start::link_changed(Turn& t) {
    drive_.presence.begin(t.now);
    if (drive_.presence.silent(t.now) == drive::Presence::Silence::lost) lose(fmt::format("{} refuses every question", name()), t);
}

void Start::lose(std::string why, Turn& t) {
    drive_.presence.lose(t.now, pause_);
    pause_ = drive_.presence.retry_pause();
    link_rounds_ = 0;
    link_line_.clear();
    drive_.lost(why, t);
    drive_.presence.report(std::move(why), t.out);
}

void Start::lose_longer(std::string why, Turn& t) {
    pause_ = std::min(2 * pause_, drive_.bus.timing.pause_max);
    lose(std::move(why), t);
}

std::string Start::not_understood() const {
    return fmt::format("{}: what answers to {} is not understood: noise, another rate, or two drives with this name", name(),
                       drive_.address());
}

void Start::silent(Turn& t) {
    ++drive_.bus.counters.timeouts;
    const auto silence = drive_.presence.silent(t.now);
    if (silence == drive::Presence::Silence::lost) {
        lose(babble_ ? not_understood()
                     : fmt::format("{} has not answered to {} {} times in a row{}", name(), drive_.address(), drive_.presence.silences(),
                                   factory_hint()),
             t);
    } else if (silence == drive::Presence::Silence::still_absent) {
        pause_ = drive_.presence.retry_pause();
        drive_.presence.report(
            babble_ ? not_understood() : fmt::format("{} does not answer to {}{}", name(), drive_.address(), factory_hint()), t.out);
    }
}

/// An echo is silence; anything else is somebody who is not understood.
void Start::received(Verdict v, const ReplyReader& r) noexcept {
    if (v != Verdict::waiting && v != Verdict::garbled) {
        drive_.presence.answered();
        spoiled_ = 0;
    }
    babble_ =
        v == Verdict::waiting && r.raw().find("PR \"#") == std::string::npos && r.raw().find_first_not_of("\r\n") != std::string::npos;
}

// --- what it is asked ------------------------------------------------------------------------------------------------------------

Request Start::next() {
    if (drive_.presence.is(Phase::starting)) {
        const auto item = first_questions[item_];
        return Request::ask(What::startup, item == "VI" ? feedback().value_items() : std::string(item));
    }
    if (!link_line_.empty()) return Request::say(What::link, link_line_);
    Request r;
    if (drive_.mode.probes_by_line() && !drive_.bus.only_reads) {
        r = Request::say(What::probe, "PG");
        drive_.mode.sending(r.text);
    } else {
        r = Request::ask(What::probe, drive_.bus.ethernet || drive_.mode.suspected() ? "EM" : "EM,CK,ES,CE");
    }
    r.wake = true;
    return r;
}

void Start::ended(Verdict v, const ReplyReader& r, bool mode_line, Turn& t) {
    const bool received = v != Verdict::waiting;
    if (drive_.presence.is(Phase::starting)) return read(v, r.data(), t);
    if (!link_line_.empty()) {
        // A probe says what it has become. After CK = 1 the first probe without a checksum is answered with NAK.
        unproven_ = v == Verdict::answered ? std::exchange(link_line_, {}) : std::string();
        unproven_at_once_ = drive_.turnaround.at_once();
        link_line_.clear();
        if (!received) silent(t);
        return;
    }
    if (mode_line) {
        drive_.mode.line_probed();
        again(t);
        if (!received) silent(t);
        return;
    }
    if (drive_.mode.probed(v, r, t)) return;
    std::string link = r.data();
    std::erase(link, ' ');  // some drives print a blank in front of a number that is not negative (E-12)
    if (v == Verdict::answered && link.size() == (drive_.bus.ethernet ? 1U : 4U)) return probe_answered(link, t);
    drive_.errors.raised_by_search();
    drive_.words.sums = !drive_.words.sums && !drive_.bus.ethernet;
    if (!received) return silent(t);
    again(t);
    const bool absent = drive_.presence.is(Phase::absent);
    if (++spoiled_ > 2 * drive_.bus.timing.silent_limit || absent) {
        // NAK is a drive that is there: the other way is tried soon.
        if (v == Verdict::refused) pause_ = {};
        absent&& v != Verdict::refused ? lose_longer(not_understood(), t) : lose(not_understood(), t);
    }
}

/// The line that brings its link nearer to what is wanted; empty: it is so.
std::string Start::wanted_word() const {
    const LinkWords& w = drive_.words;
    const Bus& bus = drive_.bus;
    if (bus.only_reads) return {};
    if (w.em != bus.em) return fmt::format("EM={}", bus.em);
    if (!bus.ethernet && w.ck != bus.ck) return fmt::format("CK={}", bus.ck);
    // With ES = 1 an ESC meant for one drive would stop them all [L2742-2744].
    if (drive_.link().party() && w.es != 3) return "ES=3";
    // With CE = 1 every CTRL+C on the wires restarts it; with 2 one behind its own name does [L2005-2006].
    if (drive_.link().party() && w.ce == 1) return "CE=2";
    return {};
}

void Start::probe_answered(const std::string& data, Turn& t) {
    LinkWords& w = drive_.words;
    const Bus& bus = drive_.bus;
    const auto digit = [&](std::size_t i, int otherwise) { return bus.ethernet ? otherwise : data[i] - '0'; };
    w = {.sums = digit(1, 0) > 0, .known_sums = w.known_sums, .em = data[0] - '0', .ck = digit(1, 0), .es = digit(2, 1), .ce = digit(3, 1)};
    auto line = wanted_word();
    if (const std::string said = std::exchange(unproven_, {}); !said.empty()) {
        // EM = 2 acknowledges nothing: a line that is wanted again was not received.
        if (said != line)
            drive_.turnaround.received(unproven_at_once_);
        else if (drive_.turnaround.lost(unproven_at_once_))
            link_rounds_ = 0;
    }
    if (!line.empty() && ++link_rounds_ <= link_round_limit) {
        link_line_ = std::move(line);
        if (drive_.presence.is(Phase::absent)) drive_.presence.begin(t.now);
        return;
    }
    if (!bus.only_reads && (w.em != bus.em || (!bus.ethernet && w.ck != bus.ck))) {
        note(Severity::warning, "link", 0, fmt::format("{} keeps EM={} and CK={}; it is used as it is", name(), w.em, w.ck), t);
    }
    drive_.presence.found();
    item_ = 0;
    identity_.clear();
}

/// Without an encoder ST and EE are errors; an open loop is asked for them only when no program can be disturbed by that.
bool Start::needless(std::string_view item) const noexcept {
    if (drive_.bus.only_reads && (item == "AS" || item == "ST")) return true;
    return (item == "AS" && knows_model_) || (item == "ST" && (feedback().has.encoder || running_)) ||
           (item == "BD" && drive_.bus.rate_code == 0);
}

void Start::read(Verdict v, std::string data, Turn& t) {
    if (v == Verdict::waiting) return silent(t);
    if (v == Verdict::garbled) {
        if (++spoiled_ >= 2 * drive_.bus.timing.silent_limit) lose(fmt::format("the answers of {} are spoiled", name()), t);
        return;
    }
    const bool good = v == Verdict::answered;
    data.erase(0, std::min(data.find_first_not_of(' '), data.size()));
    Feedback::Has& has = feedback().has;
    const auto item = first_questions[item_];
    if (!good) drive_.errors.raised_by_search();
    if (item == "PN") {
        if (good) identity_ = data;
        // The part number tells closed loop [L1217]: asking others for AS would be an error in them, and run their handler (OE).
        const bool closed = identity_.starts_with("LMDC"), open = identity_.starts_with("LMDO"), module = identity_.starts_with("LMM");
        has.hmt = closed;
        has.encoder = closed || module;
        knows_model_ = closed || open || module;
    } else if (item == "VR") {
        // "LMMCM 6.002, Hw: 3.2" [L6192]
        const auto digit = std::min(data.find_first_of("0123456789"), data.size());
        const auto major = good ? whole(std::string_view(data).substr(digit, data.find('.', digit) - digit)) : std::nullopt;
        has.old_firmware = major && *major < 6;
        if (good && !data.empty()) identity_ += fmt::format("{}firmware {}", identity_.empty() ? "" : ", ", data);
    } else if (item == "BY") {
        running_ = good && data == "1";
    } else if (item == "AS") {
        has.hmt = good;
    } else if (item == "ST") {
        has.encoder = good;
    } else if (item == "IF") {
        has.input = good;
    } else if (item == "BD") {
        bd_ = static_cast<int>(good ? whole(data).value_or(0) : 0);
    } else if (good) {
        feedback().learn_values(data);
    }
    do
        ++item_;
    while (item_ < first_questions.size() && needless(first_questions[item_]));
    if (item_ == first_questions.size()) came(t);
}

std::string_view Start::product() const noexcept {
    if (!knows_model_) return {};
    return identity_.starts_with("LMDC") ? "lmdc" : identity_.starts_with("LMDO") ? "lmdo" : "lmm";
}

void Start::came(Turn& t) {
    drive_.presence.made_ready();
    pause_ = {};
    link_rounds_ = 0;  // it may come again in another state: a power cycle brings back EM, CK, ES and CE of its memory
    drive_.words.known_sums = drive_.words.sums;
    at_factory_rate_ = false;
    drive_.came(identity_.empty() ? fmt::format("answers to {}", drive_.address()) : identity_, t);
}

// --- its bit rate: BD acts at the next restart only, so what will go wrong is said while it can still be heard ------------------------

std::uint32_t rate_of(int code) noexcept {
    const auto it = std::ranges::find(rates, code, &std::pair<int, std::uint32_t>::first);
    return it == rates.end() ? 0 : it->second;
}
int code_of(std::uint32_t rate) noexcept {
    const auto it = std::ranges::find(rates, rate, &std::pair<int, std::uint32_t>::second);
    return it == rates.end() ? 0 : it->first;
}

void Start::rate_set() noexcept { bd_ = drive_.bus.rate_code; }

std::string Start::rate_trouble() const {
    const int wanted = drive_.bus.rate_code;
    if (wanted == 0 || bd_ == 0 || bd_ == wanted) return {};
    return fmt::format(
        "{}: BD={}: from its next reset or power-up on it speaks at {} bit/s and is not heard on this line, which runs at {}: "
        "line.setup with save sets BD={}; or give the line baud={} when it has restarted",
        name(), bd_, rate_of(bd_), rate_of(wanted), wanted, rate_of(bd_));
}

std::string Start::factory_hint() const {
    const int wanted = drive_.bus.rate_code;
    if (!at_factory_rate_ || wanted == 0 || wanted == 96) return {};
    return fmt::format(
        "; since FD it may speak at the factory's 9600 bit/s, and this line runs at {}: give the line baud=9600, set BD={} there, "
        "program.save, reset, and then give the line its rate again",
        rate_of(wanted), wanted);
}

}  // namespace axisgate::mcode
