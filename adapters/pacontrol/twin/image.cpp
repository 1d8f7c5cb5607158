// The Profibus process image of the twin.
// In: the master's bytes. Out: the control's. Bytes are big-endian: byte 0 is the high byte of word 0 [L412-L417].
// Never reacts to a level where the manual has an edge: SF, both starts of CTRL, the start of an axis.
#include "adapters/pacontrol/twin/image.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "adapters/pacontrol/twin/commands.hpp"

namespace axisgate::pacontrol::twin {
namespace {
constexpr std::uint32_t bit_of(int n) { return 1u << n; }
constexpr std::uint32_t traverse_bits = 0xFCF8;  // 3..7 and 10..15

std::uint16_t word(std::span<const std::uint8_t> b, std::size_t at) { return static_cast<std::uint16_t>(b[at] << 8 | b[at + 1]); }
std::uint32_t dword(std::span<const std::uint8_t> b, std::size_t at) {
    return static_cast<std::uint32_t>(word(b, at)) << 16 | word(b, at + 2);
}
void put_word(std::span<std::uint8_t> b, std::size_t at, std::uint32_t v) {
    b[at] = static_cast<std::uint8_t>(v >> 8);
    b[at + 1] = static_cast<std::uint8_t>(v);
}
void put_dword(std::span<std::uint8_t> b, std::size_t at, std::uint32_t v) {
    put_word(b, at, v >> 16);
    put_word(b, at + 2, v & 0xFFFFu);
}
double float_of(std::uint32_t v) {
    const double d = static_cast<double>(std::bit_cast<float>(v));
    return std::isfinite(d) ? d : 0;
}
/// Bits and words of elements are 16-bit data, in bytes 2 and 3; the upper half is not looked at (E-60).
bool has_short_data(std::uint16_t code) { return code >= 0x0902 && code <= 0x0905; }
/// Axis commands belong to the axis interface where there is one [L640].
bool blocked(std::uint16_t code) {
    const CommandRow* row = find_command(code);
    return row && row->blocked_by_modules;
}
/// Status bits 0 to 6 and 8 to 13 [L788-L836]. Axis groups have no parameter number in the manual: all axes count as one group.
std::uint32_t status_bits(const Control& control, int channel) {
    const Axis& a = control.axis(channel);
    const bool powered = a.state().enabled();
    std::uint32_t s = powered ? bit_of(0) : bit_of(2);
    s |= a.state().power == AxisPower::halt ? bit_of(1) : 0u;
    s |= a.state().power == AxisPower::safe ? bit_of(3) : 0u;
    s |= a.state().power == AxisPower::idle ? bit_of(4) : 0u;
    s |= a.state().power == AxisPower::disabled ? bit_of(5) : 0u;
    s |= a.state().fault != 0 ? bit_of(6) : 0u;
    s |= a.state().referenced ? bit_of(8) : 0u;
    s |= a.switches().limit(false) ? 0u : bit_of(9);  // 0 is actuated, whatever the type of the switch
    s |= a.switches().limit(true) ? 0u : bit_of(10);
    s |= a.traverse().stopped_by_condition() ? bit_of(11) : 0u;
    s |= a.state().displaced ? bit_of(12) : 0u;
    for (int n = 1; n <= control.axes(); ++n)
        s |= control.axis(n).state().displaced ? bit_of(13) : 0u;
    return s;
}

std::optional<AxisTask::Kind> kind_of(std::uint32_t traverse) {
    using K = AxisTask::Kind;
    switch (traverse) {
        case bit_of(3):
            return K::reference;
        case bit_of(4):
            return K::set_g26;
        case bit_of(5):
            return K::set_g29;
        case bit_of(6):
            return K::absolute;
        case bit_of(7):
            return K::relative;
        case bit_of(10):
            return K::free_positive;
        case bit_of(11):
            return K::free_negative;
        case bit_of(12):
            return K::delete_g29;
        case bit_of(13):
            return K::reset_displaced;
        case bit_of(14):
            return K::to_max;
        case bit_of(15):
            return K::to_min;
        default:
            return std::nullopt;
    }
}
bool uses_speed(AxisTask::Kind k) {  // the reference run ignores both [L934]
    using K = AxisTask::Kind;
    return k == K::absolute || k == K::relative || k == K::free_positive || k == K::free_negative || k == K::to_max || k == K::to_min;
}
bool needs_reference(AxisTask::Kind k) { return uses_speed(k) && k != AxisTask::Kind::free_positive && k != AxisTask::Kind::free_negative; }
}  // namespace

std::size_t ImageShape::bytes() const noexcept { return interbus || !ctrl ? 8 : 16 + 12 * std::min<std::size_t>(modules, 8); }

bool carries_real(std::uint16_t code) noexcept {
    switch (code) {
        case 0x0800:
        case 0x0907:
        case 0x0A86:
        case 0x0A87:
        case 0x0A89:
        case 0x0A8D:
        case 0x0A8E:
        case 0x0A90:
        case 0x0A91:
        case 0x0A94:
        case 0x0A95:
        case 0x0A96:
            return true;
        default:
            return false;
    }
}

Image::Image(const ImageShape& shape) : shape_(shape), in_(shape.bytes()), out_(shape.bytes()) {
    if (shape_.interbus || !shape_.ctrl) shape_.modules = 0;
    shape_.modules = std::min<std::size_t>(shape_.modules, 8);
    shape_.error_word = std::clamp<std::size_t>(shape_.error_word, 1, 3);
}

std::span<const std::uint8_t> Image::exchange(Control& control, std::span<const std::uint8_t> in, Instant now) {
    if (in.size() != in_.size()) return out_;
    if (!std::ranges::equal(in, in_)) changed_ = now;
    std::ranges::copy(in, in_.begin());
    control.advance(now);
    // In home position the format follows; the value that is there when the control leaves stays [L592].
    const bool at_home = column_of(control.status()) == gate::home;
    if (at_home && shape_.bytes() > 8) integers_ = (word(in_, 8) & 0x8000u) != 0;
    command(control, now);
    if (shape_.bytes() > 8) control_word(control, now);
    for (std::size_t k = 0; k < shape_.modules; ++k) {
        if (column_of(control.status()) == gate::automatic) {
            elements(control, k, now);
        } else {
            axis(control, k, now);
        }
    }
    return out_;
}

InterbusDiagnosis Image::diagnosis(Instant now) const noexcept {
    if (changed_ == never) return {};
    const bool late = now - changed_ > std::chrono::seconds(10);
    return {!late, late, commanded_, stopped_by_zeros_};
}

void Image::command(Control& control, Instant now) {
    const bool zeros = std::ranges::all_of(std::span(in_).first(8), [](std::uint8_t b) { return b == 0; });
    if (shape_.interbus && zeros && commanded_) {
        // Emergency stop, once for each time that the bits fall [L1776]. No command: SF counts on from where it falls to.
        if (!stopped_by_zeros_) control.operation().emergency_stop(now);
        stopped_by_zeros_ = true;
        sf_ = false;
    } else {
        stopped_by_zeros_ = false;
    }
    const std::uint16_t w = word(in_, 6);
    const bool sf = (w & 0x8000u) != 0;
    std::optional<CommandReply> reply;
    if (sf != sf_) {
        sf_ = sf;
        commanded_ = true;
        const auto code = static_cast<std::uint16_t>(w & 0x7FFFu);
        const std::uint32_t raw = has_short_data(code) ? dword(in_, 0) & 0xFFFFu : dword(in_, 0);
        const Datum data =
            carries_real(code) ? Datum::number(float_of(raw)) : Datum::integer(static_cast<double>(static_cast<std::int32_t>(raw)));
        reply = shape_.modules > 0 && blocked(code) ? CommandReply{quit::inadmissible, true, {}, never}  // E-63
                                                    : control.execute(code, word(in_, 4), data, now);
        running_ = reply->quit == 0 && !reply->done;
    } else if (running_) {
        reply = control.progress(now);
        running_ = !reply->done;
    }
    const std::span<std::uint8_t> out(out_);
    if (reply) {
        // Reals are IEEE here whatever the format of the modules (bit 15 of CTRL).
        put_dword(out, 0,
                  reply->data.real ? std::bit_cast<std::uint32_t>(single(reply->data).value_or(0.0F))
                                   : static_cast<std::uint32_t>(whole(reply->data)));
        const bool failed = reply->quit != 0;
        put_word(out, 6, (sf_ ? 0x8000u : 0u) | (failed ? 0x4000u : reply->done ? 0x2000u : 0u) | (reply->quit & 0x1FFFu));
    } else if (stopped_by_zeros_) {
        put_word(out, 6, word(out, 6) & 0x7FFFu);
    }
    put_word(out, 4, (control.shown_error() != 0 ? 0x8000u : 0u) | control.status());
}

void Image::control_word(Control& control, Instant now) {
    const std::uint16_t w = word(in_, 8);
    const auto rising = static_cast<std::uint16_t>(w & ~ctrl_), falling = static_cast<std::uint16_t>(~w & ctrl_);
    ctrl_ = w;
    // Bits 0 to 2 are low-active. Reset acts at its edge, stop and cancel as long as they are low (E-18).
    if (falling & 1u) control.operation().reset_error(now);
    const std::uint8_t s = control.status();
    const bool cancelled = !(w & 4u), stopped = !(w & 2u);
    const std::uint8_t column = column_of(s);
    if (cancelled) {
        if (column == gate::automatic || column == gate::online) control.operation().cancel(now);
    } else if (stopped) {
        if (s == status::automatic || s == status::auto_after_stop || s == status::online || s == status::auto_started ||
            s == status::online_started)
            control.operation().stop(now);
    } else {
        if (rising & 8u) control.operation().start_automatic(now);
        if ((rising & 16u) && !(rising & 8u)) control.operation().start_online(now);
    }
    const std::uint8_t n = control.status();  // the model's battery is always good: bit 1
    const bool automatic = column_of(n) == gate::automatic, online = column_of(n) == gate::online;
    const bool stands = n == status::auto_stopped || n == status::auto_malfunction_stopped || n == status::online_stopped ||
                        n == status::online_malfunction_stopped;
    std::uint32_t v = (n != status::none ? 1u : 0u) | 2u | (control.shown_error() != 0 ? 4u : 0u);
    v |= automatic ? (stands ? bit_of(9) : bit_of(8)) : 0u;
    v |= online ? (stands ? bit_of(11) : bit_of(10)) : 0u;
    v |= integers_ ? bit_of(15) : 0u;
    const std::span<std::uint8_t> out(out_);
    put_word(out, 8, v);
    for (std::size_t i = 1; i < 4; ++i)
        put_word(out, 8 + 2 * i, i == shape_.error_word ? control.shown_error() : 0u);
}

double Image::real_at(std::size_t at) const noexcept {
    const std::uint32_t v = dword(in_, at);
    return integers_ ? static_cast<double>(static_cast<std::int32_t>(v)) / 1000.0 : float_of(v);
}

void Image::put_real(std::size_t at, double v) noexcept {
    // Integers are the value x 1000, rounded half away from zero and held to 32 bits (E-61).
    const std::uint32_t bits = integers_ ? static_cast<std::uint32_t>(whole(Datum::integer(v * 1000.0)))
                                         : std::bit_cast<std::uint32_t>(single(Datum::number(v)).value_or(0.0F));
    put_dword(out_, at, bits);
}

/// AUTOMATIC: flag word, N and R of the module are copied at every cycle, whatever else has written them [L608-L634].
void Image::elements(Control& control, std::size_t k, Instant now) {
    const Elements& e = control.signals().elements();
    const std::size_t at = 16 + 12 * k;
    const auto here = static_cast<std::int64_t>(k) + 1, there = here + 16;
    const std::span<std::uint8_t> out(out_);
    control.set_flag_word(16 * here, word(in_, at + (shape_.wide_n ? 0 : 2)), now);
    control.set_n(here, shape_.wide_n ? static_cast<std::int32_t>(dword(in_, at + 4)) : static_cast<std::int16_t>(word(in_, at + 6)));
    control.set_r(here, static_cast<float>(real_at(at + 8)));
    std::ranges::fill(out.subspan(at, 12), std::uint8_t{0});
    put_word(out, at + (shape_.wide_n ? 0 : 2), e.flags.word_of(16 * there));
    const auto n = static_cast<std::uint32_t>(e.n.get(there));
    if (shape_.wide_n) {
        put_dword(out, at + 4, n);
    } else {
        put_word(out, at + 6, n & 0xFFFFu);
    }
    put_real(at + 8, static_cast<double>(e.r.get(there)));
    modules_[k].active = false;
}

/// ONLINE and home position: the axis of the module's number. Control is taken in ONLINE alone [L709].
void Image::axis(Control& control, std::size_t k, Instant now) {
    const std::size_t at = 16 + 12 * k;
    const std::span<std::uint8_t> out(out_);
    const int channel = static_cast<int>(k) + 1;
    if (channel > control.axes()) {
        std::ranges::fill(out.subspan(at, 12), std::uint8_t{0});
        return;
    }
    Module& m = modules_[k];
    const std::uint32_t w = dword(in_, at);
    if (column_of(control.status()) == gate::online) {
        const std::uint32_t changed = w ^ m.control;
        const bool moving = control.axis(channel).running();
        if (w & bit_of(16)) {
            m.own_error = 0;
            control.operation().reset_axis_error(channel, now);
        }
        if (changed & 2u) control.motions().disable_drive(channel, (w & 2u) != 0, now);
        // A level [L727-L738]: an axis that is on by its enable mode is switched off by a 0 that has stood there from the start.
        const Axis& a = control.axis(channel);
        if (!(w & 2u) && (w & 1u) == (a.state().off || !a.state().enabled() ? 1u : 0u))
            control.motions().set_axis_on(channel, (w & 1u) != 0, now);
        const std::uint16_t speed = word(in_, at + 6);
        if ((w & 4u) && (changed & 4u)) {
            if (!moving) start(control, k, m, w, now);  // a start during a traverse is not seen [L742]
        } else if (moving && m.active) {
            // The traverse bit is taken away [L725]; a new position waits for the next start.
            if (m.control & ~w & traverse_bits) control.motions().interrupt_axis(channel, now);
            if (speed != m.speed && speed >= 1 && speed <= 1000) control.motions().change_axis_speed(channel, speed, now);
        }
        m.speed = speed;
        m.control = w;
    } else {
        m.control = 0;  // ONLINE begins with nothing commanded: a level that stands already is an edge then
        m.active = false;
        m.command_error = 0;
    }
    const Axis& is = control.axis(channel);
    if (m.active && !is.traverse().busy() && !(w & 4u)) m.active = false;
    const std::uint16_t error = is.state().fault != 0 ? is.state().fault : m.own_error;
    std::uint32_t s = status_bits(control, channel);
    s |= (m.active ? bit_of(7) : 0u) | (m.command_error != 0 ? bit_of(14) : 0u) | (error != 0 ? bit_of(15) : 0u);
    put_dword(out, at, s);
    put_word(out, at + 4, m.command_error);
    put_word(out, at + 6, error);
    put_real(at + 8, is.shaft().position(now));
}

void Image::start(Control& control, std::size_t k, Module& m, std::uint32_t w, Instant now) {
    const std::size_t at = 16 + 12 * k;
    m.command_error = 0;
    m.active = false;
    const std::uint32_t traverse = w & traverse_bits;
    const auto kind = kind_of(traverse);
    AxisTask task;
    task.acceleration_permille = word(in_, at + 4);
    task.speed_permille = word(in_, at + 6);
    task.value = real_at(at + 8);
    const std::uint32_t conditions = w & (bit_of(8) | bit_of(9));
    if (traverse == 0) {
        m.command_error = quit::not_executable;
    } else if (!kind || conditions == (bit_of(8) | bit_of(9))) {
        m.command_error = m.own_error = quit::inadmissible;  // several at once: both errors [L712-L716], E-36
    } else if (uses_speed(*kind) && (task.speed_permille < 1 || task.speed_permille > 1000 || task.acceleration_permille == 0)) {
        m.command_error = quit::value;  // E-67
    } else if (needs_reference(*kind) && !control.axis(static_cast<int>(k) + 1).state().referenced) {
        m.command_error = quit::no_reference;
        m.own_error = error::no_reference;
    } else {
        task.kind = *kind;
        if (conditions && (*kind == AxisTask::Kind::absolute || *kind == AxisTask::Kind::relative))
            task.while_input = (conditions & bit_of(8)) != 0;
        task.limits_monitored = (w & bit_of(17)) == 0 || *kind == AxisTask::Kind::reference;
        m.command_error = control.motions().start_task(static_cast<int>(k) + 1, task, now);
        m.active = m.command_error == 0;
    }
}

}  // namespace axisgate::pacontrol::twin
