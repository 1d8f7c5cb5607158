// Maker of the PA-CONTROL twin, and its serial slave.
// In: setup, bytes, time. Out: a control without power; acknowledgements.
// Never fails: what it cannot read of its options stays at the default.
#include "adapters/pacontrol/twin/twin.hpp"

#include <algorithm>
#include <charconv>

#include "adapters/pacontrol/twin/device.hpp"
#include "adapters/pacontrol/twin/freedoms_read.hpp"

namespace axisgate::pacontrol::twin {
namespace {

std::optional<std::int64_t> number(std::string_view text, std::int64_t least, std::int64_t largest) {
    std::int64_t n = 0;
    const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), n);
    if (fault != std::errc{} || end != text.data() + text.size() || n < least || n > largest) return std::nullopt;
    return n;
}

std::vector<std::string_view> split(std::string_view text, char at) {
    std::vector<std::string_view> parts;
    for (;;) {
        const auto end = text.find(at);
        parts.push_back(text.substr(0, end));
        if (end == std::string_view::npos) return parts;
        text.remove_prefix(end + 1);
    }
}

std::optional<double> real(std::string_view text, double least, double largest) {
    double v = 0;
    const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), v);
    if (fault != std::errc{} || end != text.data() + text.size() || !(v >= least && v <= largest)) return std::nullopt;
    return v;
}

/// `A1=100/A2=-50`; empty: it cannot be read.
std::vector<ProgramMove> moves_of(std::string_view text) {
    std::vector<ProgramMove> moves;
    for (const auto item : split(text, '/')) {
        const auto part = split(item, '=');
        const auto axis = part[0].starts_with('A') ? number(part[0].substr(1), 1, 16) : std::nullopt;
        const auto target = part.size() == 2 ? real(part[1], -1e7, 1e7) : std::nullopt;
        if (!axis || !target || moves.size() == 64) return {};
        moves.push_back({static_cast<int>(*axis), *target});
    }
    return moves;
}

/// `NAME:ms[:error[:A1=100/A1=0]]`, with commas; what cannot be read is left out.
std::vector<Program> programs_of(std::string_view text) {
    std::vector<Program> programs;
    for (const auto item : split(text, ',')) {
        const auto part = split(item, ':');
        if (part.size() < 2 || part.size() > 4 || part[0].empty() || programs.size() == 32) continue;
        const auto ms = number(part[1], 0, 86'400'000);
        const auto error = part.size() >= 3 ? number(part[2], 0, 999) : std::optional<std::int64_t>(0);
        auto moves = part.size() == 4 ? moves_of(part[3]) : std::vector<ProgramMove>{};
        if (!ms || !error || (part.size() == 4 && moves.empty())) continue;
        programs.push_back({std::string(part[0]), std::chrono::milliseconds(*ms), static_cast<std::uint16_t>(*error), std::move(moves)});
    }
    return programs;
}

/// `AP1:0.001:2000[:500]`, with commas: least, largest and, if it is another than now, the usual value.
void limits_of(std::string_view text, int axes, Profile& profile) {
    for (const auto item : split(text, ',')) {
        const auto part = split(item, ':');
        if (part.size() < 3 || part.size() > 4 || part[0].size() < 3) continue;
        const bool of_axis = part[0].starts_with("AP");
        const auto n = of_axis || part[0].starts_with("SP") ? number(part[0].substr(2), 1, of_axis ? 50 : 20) : std::nullopt;
        const auto least = real(part[1], -1e9, 1e9), largest = real(part[2], -1e9, 1e9);
        if (!n || !least || !largest || *least > *largest) continue;
        const auto i = static_cast<std::size_t>(*n);
        const double now = of_axis ? static_cast<double>(profile.axis(i).usual) : profile.system(i, axes).usual;
        const double usual = std::clamp(part.size() == 4 ? real(part[3], -1e9, 1e9).value_or(now) : now, *least, *largest);
        if (of_axis) {
            (void)profile.set_axis(i, {static_cast<float>(*least), static_cast<float>(usual), static_cast<float>(*largest)});
        } else {
            (void)profile.set_system(i, {whole(Datum::integer(*least)), whole(Datum::integer(usual)), whole(Datum::integer(*largest))});
        }
    }
}

}  // namespace

std::unique_ptr<Twin> make_twin(const Catalogue&, const TwinSetup& setup) {
    DeviceSetup d;
    const auto text = [&](const char* name) { return option(setup.options, name, ""); };
    const auto built = number(text("axes"), 1, 16);
    d.fixed_axes = built.has_value();
    d.control.axes = static_cast<int>(built.value_or(std::clamp(setup.axes, 1, 16)));
    take_freedoms(setup, d);
    if (text("reply_check") == "text") d.reply_check = ReplyCheck::text;
    if (text("reply_check") == "zero") d.reply_check = ReplyCheck::zero;
    if (text("request_check") == "lenient") d.answers.frames.check = RequestCheck::either;
    if (text("model") == "other") d.control.axis.ep = false;
    if (text("measuring") == "off") d.control.axis.measuring = false;
    if (text("absolute") == "off") d.control.absolute = false;
    if (const auto n = number(text("switch_on_mode"), 0, 4)) d.control.axis.switch_on_mode = static_cast<int>(*n);
    if (const auto n = number(text("max_displacement"), 0, 1'000'000)) d.control.axis.max_displacement = static_cast<double>(*n);
    d.control.axis.manual_at_traverse = text("manual_speed") == "traverse";
    if (auto programs = programs_of(text("programs")); !programs.empty()) d.control.programs = std::move(programs);
    if (setup.options.contains("lasting_errors")) {
        d.control.lasting.clear();
        const std::string list = text("lasting_errors");
        for (const auto item : split(list, ',')) {
            if (const auto n = number(item, 1, 999)) d.control.lasting.insert(static_cast<std::uint16_t>(*n));
        }
    }
    d.control.axis_modules = text("axis_modules") == "on";
    if (const auto n = number(text("profibus_switches"), 0, 99)) d.control.profibus_switches = static_cast<int>(*n);
    if (const std::string list = text("limits"); !list.empty()) limits_of(list, d.control.axes, d.control.profile);
    const std::string travel = text("travel"), rotary = text("rotary");
    if (const auto ends = split(travel, ':'); ends.size() == 2) {
        const auto low = real(ends[0], -1e8, 1e8), high = real(ends[1], -1e8, 1e8);
        if (low && high && *low < *high) {
            d.control.axis.travel_min = *low;
            d.control.axis.travel_max = *high;
        }
    }
    for (const auto item : split(rotary, ',')) {
        const auto part = split(item, ':');
        const auto n = number(part[0], 1, 16);
        const auto ae = part.size() == 2 ? real(part[1], 0.001, 1e6) : std::nullopt;
        if (n && ae) d.control.rotary[static_cast<int>(*n)] = *ae;
    }
    return std::make_unique<Device>(d);
}

void Device::power_on(const NonVolatile& memory, Instant now, Out& out) {
    last_ = std::max(now, last_);
    powered_ = true;
    waiting_.clear();
    reader_.reset();
    deaf_until_ = Instant::min();
    control_.power_on(memory, last_);
    announced_error_ = control_.shown_error();
    announce_power(last_, out);
}

void Device::announce_power(Instant now, Out& out) const {
    if (silent_) return;
    if (setup_.answers.at_power_on == Announcement::acknowledgement) return send({}, now, out);
    if (setup_.answers.at_power_on == Announcement::none) return;
    static constexpr std::string_view text = "PA-CONTROL V5.23\r\n";
    Frame f = Frame::run({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
    f.at = now;
    out.send(f);
}

void Device::announce_error(Instant now, Out& out) {
    if (!powered_ || std::exchange(announced_error_, control_.shown_error()) == control_.shown_error()) return;
    if (setup_.answers.errors_announced) send({}, now, out);
}

bool Device::fit_axes(int axes, Instant now) {
    last_ = std::max(now, last_);
    if (setup_.fixed_axes) return true;
    setup_.control.axes = std::clamp(axes, 1, 16);
    control_.fit_axes(axes, last_);
    return true;
}

Instant Device::deadline() const {
    if (!powered_) return never;
    Instant next = control_.deadline();
    if (setup_.answers.silence_answered) next = std::min(next, reader_.forgets());
    return waiting_.empty() ? next : std::min(next, waiting_.front().at);
}

/// Time passes up to `now`; acknowledgements leave at their own instants.
void Device::pass(Instant now, Out& out) {
    last_ = now;
    while (powered_ && !waiting_.empty() && waiting_.front().at <= now) {
        const Waiting w = waiting_.front();
        waiting_.pop_front();
        control_.advance(w.at);
        send(w.refresh ? control_.progress(w.at) : w.reply, w.at, out);
    }
    if (powered_ && setup_.answers.silence_answered && reader_.forgets() <= now) {
        const Instant over = reader_.forgets();
        control_.advance(over);
        reader_.reset();
        control_.note_frame_error(quit_sequence);
        answer({quit_sequence, true, {}, never}, over, out);
    }
    if (powered_) control_.advance(now);
    announce_error(now, out);
}

void Device::on_deadline(Instant now, Out& out) { pass(std::max(now, last_), out); }

void Device::on_frame(const Frame& frame, Instant now, Out& out) {
    now = std::max(now, last_);
    pass(now, out);
    if (!powered_ || frame.kind != Frame::Kind::bytes || now < deaf_until_) return;
    for (const std::uint8_t byte : frame.data()) {
        if (const auto h = reader_.feed(byte, now)) received(*h, now, out);
    }
}

void Device::received(const Received& h, Instant now, Out& out) {
    // The master did not wait: what still waits for an end of processing leaves as it is.
    if (!waiting_.empty() && waiting_.back().refresh) {
        const CommandReply r = control_.progress(now);
        waiting_.back() = {now, false, r};
        pass(now, out);
    }
    switch (h.kind) {
        case Received::Kind::poll: {
            const bool idle = !control_.pending();
            const CommandReply r = control_.progress(now);
            if (idle && setup_.answers.idle_poll == IdlePoll::none) return;
            return answer(idle && setup_.answers.idle_poll == IdlePoll::empty ? CommandReply{} : r, now, out);
        }
        case Received::Kind::fault:
            control_.note_frame_error(h.quit);
            return answer({h.quit, true, {}, never}, now, out);
        case Received::Kind::request:
            break;
    }
    const CommandReply reply = control_.execute(h.code, h.parameter, h.data, now);
    const bool stores = reply.quit == 0 && (h.code == 0x0700 || h.code == 0x0800);
    if (stores) deaf_until_ = now + setup_.answers.parameter_store;
    if (!reply.unanswered) answer(reply, now, out, deaf_until_);
}

void Device::answer(const CommandReply& reply, Instant now, Out& out, Instant earliest) {
    Instant at = std::max(now, earliest);
    const bool refresh = !reply.done && reply.expected != never && reply.expected - now <= patience;
    if (refresh) at = std::max(at, reply.expected);
    if (at <= now && waiting_.empty()) return send(reply, now, out);
    if (waiting_.size() < waiting_limit) waiting_.push_back({at, refresh, reply});
}

void Device::send(const CommandReply& reply, Instant now, Out& out) const {
    if (silent_) return;
    const auto bytes = acknowledgement(reply.quit, reply.done, control_.status(), control_.shown_error(), reply.data, setup_.reply_check,
                                       setup_.answers.reals);
    Frame f = Frame::run(bytes);
    f.at = now;
    out.send(f);
}

TwinMechanics Device::mechanics(int channel, Instant now) const {
    if (channel < 1 || channel > control_.axes()) return {};
    const Axis& a = control_.axis(channel);
    now = std::max(now, last_);
    return {a.shaft().place(now) * 1000, a.shaft().velocity(now) * 1000, powered_ && a.state().enabled() && !a.state().measuring};
}

}  // namespace axisgate::pacontrol::twin
