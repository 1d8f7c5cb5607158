// The words for enumerators in REST answers, events and messages, in one place for all doors. They are part of the contract: never
// translated, never changed.
#include <fmt/core.h>

#include <algorithm>
#include <array>

#include "gateway/core/command.hpp"
#include "gateway/core/frame.hpp"
#include "gateway/core/sample.hpp"
#include "gateway/core/scan.hpp"

namespace axisgate {

namespace {
constexpr std::array<std::string_view, 3> set_point_modes{"position", "velocity", "torque"};
}  // namespace

std::string_view name_of(SetPoint::Mode mode) noexcept { return set_point_modes[static_cast<std::size_t>(mode)]; }

std::optional<SetPoint::Mode> set_point_mode_of(std::string_view name) noexcept {
    const auto found = std::ranges::find(set_point_modes, name);
    if (found == set_point_modes.end()) return std::nullopt;
    return static_cast<SetPoint::Mode>(found - set_point_modes.begin());
}

std::string_view name_of(Outcome outcome) noexcept {
    switch (outcome) {
        case Outcome::accepted:
            return "accepted";
        case Outcome::done:
            return "done";
        case Outcome::refused:
            return "refused";
        case Outcome::failed:
            return "failed";
    }
    return "failed";
}

std::string_view name_of(Reason reason) noexcept {
    switch (reason) {
        case Reason::none:
            return "none";
        case Reason::out_of_range:
            return "out_of_range";
        case Reason::unknown_point:
            return "unknown_point";
        case Reason::not_writable:
            return "not_writable";
        case Reason::wrong_state:
            return "wrong_state";
        case Reason::not_supported:
            return "not_supported";
        case Reason::drive_refused:
            return "drive_refused";
        case Reason::busy:
            return "busy";
        case Reason::line_down:
            return "line_down";
        case Reason::no_answer:
            return "no_answer";
        case Reason::interrupted:
            return "interrupted";
        case Reason::authority:
            return "authority";
        case Reason::not_stored:
            return "not_stored";
        case Reason::internal:
            return "internal";
    }
    return "internal";
}

std::string_view name_of(DemandSource source) noexcept {
    switch (source) {
        case DemandSource::none:
            return "none";
        case DemandSource::drive:
            return "drive";
        case DemandSource::computed:
            return "computed";
        case DemandSource::open_loop:
            return "open_loop";
    }
    return "none";
}

std::string_view name_of(Severity severity) noexcept {
    switch (severity) {
        case Severity::info:
            return "info";
        case Severity::warning:
            return "warning";
        case Severity::alarm:
            return "alarm";
    }
    return "info";
}

std::string_view name_of(const CommandBody& body) noexcept {
    struct Names {
        std::string_view operator()(const Enable&) const { return "enable"; }
        std::string_view operator()(const Disable&) const { return "disable"; }
        std::string_view operator()(const QuickStop&) const { return "quick_stop"; }
        std::string_view operator()(const Halt&) const { return "halt"; }
        std::string_view operator()(const ResetFault&) const { return "reset_fault"; }
        std::string_view operator()(const Home&) const { return "home"; }
        std::string_view operator()(const SetPosition&) const { return "set_position"; }
        std::string_view operator()(const Move& m) const {
            return m.kind == Move::Kind::absolute ? "move_absolute" : m.kind == Move::Kind::relative ? "move_relative" : "move_velocity";
        }
        std::string_view operator()(const StartTogether&) const { return "start_together"; }
        std::string_view operator()(const ReadParameter&) const { return "read_parameter"; }
        std::string_view operator()(const WriteParameter&) const { return "write_parameter"; }
        std::string_view operator()(const Native&) const { return "native"; }
        std::string_view operator()(const Action&) const { return "action"; }
        std::string_view operator()(const Hand&) const { return "hand"; }
        std::string_view operator()(const ProcessData&) const { return "process_data"; }
        std::string_view operator()(const HoldAxis& h) const {
            return h.kind == HoldAxis::Kind::take      ? "take_authority"
                   : h.kind == HoldAxis::Kind::release ? "release_authority"
                                                       : "hand_over_authority";
        }
    };
    return std::visit(Names{}, body);
}

std::string to_text(const Frame& frame) {
    std::string s;
    if (frame.kind == Frame::Kind::bytes) {
        for (const auto b : frame.data())
            s += fmt::format("{}{:02X}", s.empty() ? "" : " ", b);
        return s;
    }
    if (frame.kind == Frame::Kind::can_error) {
        s = fmt::format("error {:08X}#", frame.id);
    } else {
        s = frame.extended ? fmt::format("{:08X}#", frame.id) : fmt::format("{:03X}#", frame.id);
        if (frame.remote) return s + "R";
    }
    for (const auto b : frame.data())
        s += fmt::format("{:02X}", b);
    return s;
}

std::string_view name_of(ScanReport::State state) noexcept {
    switch (state) {
        case ScanReport::State::none:
            return "none";
        case ScanReport::State::running:
            return "running";
        case ScanReport::State::done:
            return "done";
        case ScanReport::State::failed:
            return "failed";
        case ScanReport::State::cancelled:
            return "cancelled";
    }
    return "none";
}

}  // namespace axisgate
