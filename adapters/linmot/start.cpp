// How a drive is found and lost: its first answer, the values that moves rest on, the silence.
// In: the line's state, answers to probes, silences. Out: presence, links. Never writes anything to a drive that was just found.
#include <fmt/core.h>

#include "adapters/linmot/drive.hpp"
#include "gateway/drive/option_reader.hpp"

namespace axisgate::linmot {
namespace {}

Duration Bus::wire(std::size_t bytes) const noexcept {
    return bit_rate == 0 ? Duration{} : Duration{static_cast<std::int64_t>(bytes * bits_per_byte * 1'000'000'000ull / bit_rate)};
}

Drive::Drive(Bus& bus, const DriveSetup& setup, std::uint8_t id, std::size_t slot)
    : bus_(bus), setup_(setup), id_(id), slot_(slot), presence_(setup.id, bus.timing), notices_(setup.id) {
    for (const AxisSetup& a : setup.axes) {
        if (a.channel == 1) axis_ = a.id;
    }
    drive::OptionReader options(setup.options);
    warn_inferred_ = options.word("warn_word", {"off", "inferred"}) == "inferred";
    inferred_ = options.flag("inferred", true);
    stop_by_off3_ = options.word("quick_stop", {"abort", "off3"}) == "off3";
    const auto set_points = options.word("set_points", {"moves", "auto", "stream"});
    streams_ = set_points != "moves";
    if (set_points == "stream" && stream_period() <= Duration{})
        options.fault(
            "set_points: a stream needs a set-point every 2 to 5 ms, which this line cannot hold (a bit rate of 115200 or more, and "
            "no other drive): set-points are sent as moves");
    option_faults_ = options.take_faults();
}

std::string Drive::title() const { return fmt::format("{} (ID {})", setup_.name, id_); }

void Drive::begin(Turn& t) {
    for (auto& fault : option_faults_)
        notices_.tell(Severity::warning, axis_, "setup", 0, std::move(fault), t.now, t.out);
    option_faults_.clear();
}

void Drive::line_up(Turn& t) {
    presence_.begin(t.now);
    late_.settled();
    status_known_ = cw_known_ = false;
    told_state_ = 0xFF;
}

void Drive::line_down(Turn& t, std::string_view why) {
    presence_.close();
    exchange_.drop();
    poll_.stop();
    lost(t, {});
    tickets_.fail_all(Reason::line_down, why, t.out);
    presence_.report(std::string(why), t.out);
}

void Drive::remove(Turn& t, std::string_view why) {
    presence_.close();
    exchange_.drop();
    lost(t, {});
    tickets_.fail_all(Reason::line_down, why, t.out);
}

/// Forgets what only a drive that answers can know. With a reason: everything that waits ends by it.
void Drive::lost(Turn& t, std::string why) {
    queue_.clear();
    set_points_.clear();
    stops_.clear();
    job_ = {};
    stream_ = {};
    poll_.stop();
    release_home_ = homing_ = motion_fresh_ = to_target_ = false;
    status_known_ = cw_known_ = false;
    told_state_ = 0xFF;
    track_.clear();
    demand_.forget();
    if (why.empty()) return;
    tickets_.fail_all(Reason::no_answer, why, t.out);
    presence_.report(std::move(why), t.out);
}

void Drive::find(const Telegram& telegram, Turn& t) {
    const auto status = status_of(telegram);
    if (!status || telegram.size != default_size || telegram.sub != 0) {
        not_ours_ = fmt::format("the default response of drive {} is reconfigured: {} bytes of data instead of {}; set its parameters back",
                                title(), telegram.size, default_size);
        presence_.lose(t.now);
        lost(t, not_ours_);
        return;
    }
    not_ours_.clear();
    presence_.found();
    count_ = 0;
    learn(*status, t);
    reading_.begin(axis_ == no_axis ? 0 : std::size(core_values), axis_ == no_axis ? 0 : std::size(core_values));
    if (reading_.core_pending()) return;
    presence_.made_ready();
    presence_.report(fmt::format("LinMot drive, {}", state_text()), t.out);
}

/// The limits of predefined moves: what a move uses that names none.
void Drive::core_answered(const Telegram& telegram, Turn& t) {
    if (const auto status = status_of(telegram)) learn(*status, t);
    auto& value = reading_.at() == 0 ? vmax_ : reading_.at() == 1 ? acc_ : dec_;
    value = telegram.size == ram_size ? std::optional(telegram.u32(default_size)) : std::nullopt;
    if (!reading_.done()) return;
    presence_.made_ready();
    tell(t);
    presence_.report(fmt::format("LinMot drive, {}", state_text()), t.out);
    poll_.begin(t.now, bus_.timing.poll_period, slot_);
}

}  // namespace axisgate::linmot
