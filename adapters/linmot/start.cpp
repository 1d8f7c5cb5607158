// A drive without an axis (in a scan) is asked for its state only.
#include "adapters/linmot/start.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "adapters/linmot/drive.hpp"

namespace axisgate::linmot {
namespace {
constexpr std::string_view ram_is_silent = "; it does not answer reads of RAM values";
}  // namespace

void Start::probe(Turn& t) {
    if (!drive_.presence.probe_due(t.now)) return;
    drive_.presence.probe_sent();
    const bool for_position = probed_size_ == size_without_position;
    drive_.exchanges.send(
        {for_position ? request16(drive_.id(), Main::ram, 0, upid_position) : request(drive_.id(), Main::response, 1), Purpose::probe}, t);
}

Telegram Start::status_request() const {
    if (response_size_ == size_without_position) return request16(drive_.id(), Main::ram, 0, upid_position);
    return request(drive_.id(), Main::response, 1);
}

/// A RAM value that is read stands where other responses have the position.
std::optional<Status> Start::status_in(const Telegram& asked, const Telegram& answer) const noexcept {
    const bool ram = asked.main == static_cast<std::uint8_t>(Main::ram);
    if (response_size_ == size_without_position && ram && asked.u16(0) == upid_position) return status_of(answer);
    return status_of(answer, ram || answer.size >= response_size_ ? response_size_ : size_without_position);
}

bool Start::response_fits(std::size_t size) const noexcept {
    return drive_.presence.online() ? size == response_size_ : size >= size_without_position;
}

void Start::not_ours(std::string why, Turn& t) {
    probed_size_ = default_size;
    position_unread_ = 0;
    if (why != not_ours_) drive_.notice(Severity::warning, "not_served", 0, why, t);
    not_ours_ = std::move(why);
    drive_.presence.lose(t.now);
    if (drive_.stops.empty()) return drive_.lost(t, not_ours_);
    drive_.presence.report(not_ours_, t.out);  // a stop waits, and is sent next
}

std::string Start::reconfigured(std::size_t size, std::string_view why) const {
    return fmt::format(
        "drive {} answers, but its default response is reconfigured, with {} bytes of data instead of {}{}: set the content "
        "of the response back to status word, StateVar and actual position in the parameters of its LinRS interface",
        drive_.title(), size, default_size, why);
}

void Start::absent(Turn& t) {
    drive_.presence.report(not_ours_.empty() ? fmt::format("drive {} does not answer", drive_.title()) : not_ours_, t.out);
}

bool Start::probe_silent(const Request& asked, Turn& t) {
    if (asked.telegram.main != static_cast<std::uint8_t>(Main::ram) || ++position_unread_ < drive::Reading::tries) return false;
    not_ours(reconfigured(size_without_position, ", without a position, and it does not answer the read of its position (1B8Dh)"), t);
    return true;
}

/// The usual response is taken at once. Another one needs two answers, because a late answer to another master has such a size, too.
void Start::probed(const Request& asked, const Telegram& telegram, Turn& t) {
    const bool position = asked.telegram.main == static_cast<std::uint8_t>(Main::ram);
    const std::size_t size = telegram.size, before = std::exchange(probed_size_, default_size);
    position_unread_ = 0;
    if (position && telegram.storage[0] != 0)
        return not_ours(reconfigured(size_without_position, ", without a position, and it refuses the read of its position (1B8Dh)"), t);
    if (!position && size != default_size) {
        if (size != size_without_position && size != size_with_demand && size != size_with_warn) return not_ours(reconfigured(size, ""), t);
        if (size == size_without_position || size != before) {
            probed_size_ = size;
            return drive_.presence.begin(t.now);
        }
    }
    response_size_ = position ? size_without_position : size;
    not_ours_.clear();
    asks_presence_ = ram_silent_ = false;
    drive_.presence.found();
    drive_.motion.found();
    drive_.feedback.learn(*status_in(asked.telegram, telegram), t);
    const std::size_t values = drive_.axis() == no_axis ? 0 : std::size(Limits::upids);
    reading_.begin(values, values);
    if (reads()) return;
    drive_.presence.made_ready();
    drive_.presence.report(fmt::format("LinMot drive, {}", drive_.feedback.state_text()), t.out);
}

void Start::read_next(Turn& t) {
    if (asks_presence_) return drive_.exchanges.send({status_request(), Purpose::core}, t);
    drive_.exchanges.send({request16(drive_.id(), Main::ram, 0, Limits::upids[reading_.at()]), Purpose::core}, t);
}

/// The limits of predefined moves: the rates of a move without own rates.
void Start::read(const Telegram& telegram, Turn& t) {
    if (const auto status = status_of(telegram, response_size_)) drive_.feedback.learn(*status, t);
    if (std::exchange(asks_presence_, false)) {  // it answers, only not the reads of RAM values
        ram_silent_ = true;
        while (!reading_.done()) {
        }
        return ready(ram_is_silent, t);
    }
    drive_.limits.at(reading_.at()) = telegram.u32(response_size_);
    if (reading_.done()) ready("", t);
}

/// Silence upon the first value is no silence of the drive yet: what it always answers is asked before the time-outs count as its loss.
void Start::read_silent(Turn& t) {
    if (asks_presence_) return;
    reading_.silent();
    if (!reading_.given_up()) return;
    drive_.limits.at(reading_.at()).reset();
    asks_presence_ = reading_.at() == 0;
    if (!asks_presence_ && reading_.done()) ready(ram_is_silent, t);
}

/// The RAM has its power-on values after each restart of the drive, which leads to a start here, too.
void Start::set_limits() {
    const auto& axes = drive_.setup().axes;
    const Catalogue& page = drive_.bus.catalogue;
    limits_open_ = 0;
    limits_untold_ = true;
    if (axes.empty() || drive_.axis() == no_axis || (!axes[0].position_min && !axes[0].position_max)) return drive_.presence.limited({});
    if (!drive_.options.keeps_limits) return drive_.presence.limited({DriveLimits::State::off, {}});
    drive_.presence.limited({});
    for (const auto& [id, limit] : {std::pair{"146Eh", axes[0].position_min}, std::pair{"146Fh", axes[0].position_max}}) {
        const auto point = limit ? page.find(id) : std::nullopt;
        if (!point) continue;
        Command own;
        own.axis = drive_.axis();
        own.body = WriteParameter{*point, Value{std::clamp<std::int64_t>(*limit, INT32_MIN, INT32_MAX)}};
        if (drive_.jobs.queue.push(std::move(own))) ++limits_open_;
    }
}

void Start::tell_limits(Turn& t) {
    if (std::exchange(limits_untold_, false)) drive_.presence.limited(drive_.presence.limits(), t.out);
}

void Start::limit_set(std::string fault, Turn& t) {
    if (limits_open_ > 0) --limits_open_;
    drive::Presence& presence = drive_.presence;
    if (presence.limits().state == DriveLimits::State::refused) return;
    if (!fault.empty()) {
        drive_.notice(Severity::warning, "drive_limits", 0, "the drive does not take the site's limit of position: " + fault, t);
        return presence.limited({DriveLimits::State::refused, std::move(fault)}, t.out);
    }
    if (limits_open_ == 0) presence.limited({DriveLimits::State::armed, {}}, t.out);
}

void Start::read_again() {
    if (!drive_.presence.is(drive::Presence::Phase::ready) || drive_.axis() == no_axis || ram_silent_) return;
    drive_.limits = {};
    reading_.begin(std::size(Limits::upids), std::size(Limits::upids));
}

void Start::ready(std::string_view more, Turn& t) {
    if (drive_.presence.is(drive::Presence::Phase::ready)) return drive_.feedback.publish(t);  // read again
    drive_.presence.made_ready();
    set_limits();
    drive_.feedback.publish(t);
    drive_.presence.report(fmt::format("LinMot drive, {}{}", drive_.feedback.state_text(), more), t.out);
    drive_.poll.begin(t.now, drive_.bus.timing.poll_period, drive_.slot());
}

}  // namespace axisgate::linmot
