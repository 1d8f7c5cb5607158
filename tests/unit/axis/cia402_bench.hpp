// The CiA 402 profile with a drive that carries out every order at once. No family is used.
#pragma once

#include <gtest/gtest.h>

#include "gateway/axis/cia402.hpp"

namespace axisgate::cia402_bench {
using namespace cia402;
using Power = AxisFeedback::Power;

/// A drive that carries out every order at once; each report advances the time by one millisecond.
struct Bench {
    Cia402Axis profile;
    AxisFeedback drive;
    Instant now = at_ns(1'000'000);

    Bench() {
        profile.on_presence(Presence::twin);
        drive.power = Power::off;
        drive.target_reached = true;
        say();
    }
    std::optional<CommandBody> say() {
        now += std::chrono::milliseconds(1);
        drive.at = now;
        return profile.on_feedback(drive, now);
    }
    /// Carries out orders as a perfect drive would, and answers them.
    void obey(const Cia402Axis::Decision& d) {
        for (const auto& o : d.orders) {
            if (std::holds_alternative<Enable>(o)) drive.power = Power::on;
            if (std::holds_alternative<Disable>(o)) drive.power = Power::off;
            if (std::holds_alternative<ResetFault>(o)) {
                drive.fault = false;
                drive.error_code = 0;
            }
            if (std::holds_alternative<Move>(o)) {
                drive.moving = true;
                drive.target_reached = false;
            }
            if (std::holds_alternative<Halt>(o) || std::holds_alternative<QuickStop>(o)) drive.moving = false;
            say();
            profile.on_order_result(o, true, now);
        }
        say();
    }
    Cia402Axis::Decision word(std::uint16_t cw) {
        ProcessData d;
        d.controlword = cw;
        auto r = profile.on_process_data(d);
        obey(r);
        return r;
    }
    void to(PowerState wanted) {
        switch (wanted) {
            case PowerState::switch_on_disabled:
                break;
            case PowerState::ready_to_switch_on:
                word(0x06);
                break;
            case PowerState::switched_on:
                word(0x06);
                word(0x07);
                break;
            case PowerState::operation_enabled:
                word(0x06);
                word(0x07);
                word(0x0F);
                break;
            case PowerState::quick_stop_active:
                word(0x06);
                word(0x07);
                word(0x0F);
                word(0x0B);
                break;
            case PowerState::fault:
                drive.fault = true;
                drive.error_code = 7;
                say();
                break;
            case PowerState::fault_reaction_active:
                drive.fault = true;
                drive.moving = true;
                say();
                break;
            case PowerState::not_ready_to_switch_on:
                profile.on_presence(Presence::offline);
                break;
        }
        ASSERT_EQ(profile.state(), wanted) << name_of(profile.state());
    }
    [[nodiscard]] AxisPicture picture() const {
        AxisPicture p;
        profile.fill(p);
        return p;
    }
    void enable(std::int16_t mode) {
        ProcessData d;
        d.mode = mode;
        d.profile_velocity = 1000;  // a set-point without a velocity is refused
        obey(profile.on_process_data(d));
        to(PowerState::operation_enabled);
    }
    Cia402Axis::Decision data(const ProcessData& d) {
        auto r = profile.on_process_data(d);
        obey(r);
        return r;
    }
};

}  // namespace axisgate::cia402_bench
