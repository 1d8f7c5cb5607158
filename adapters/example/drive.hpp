// Drive implements the language of the example drive, which has up to four axes; drive/dialogue.hpp does the rest. drive.cpp has the state
// of an axis, motion.cpp the commands.
#pragma once

#include "adapters/example/wire.hpp"
#include "gateway/drive/dialogue.hpp"

namespace axisgate::example {
using drive::Turn;

class Drive final : public drive::Dialogue<Telegram, 4> {
public:
    Drive(drive::Bus& bus, const DriveSetup& setup, std::size_t slot, int address) : Dialogue(bus, setup, slot), address_(address) {}
    [[nodiscard]] int address() const noexcept { return address_; }

private:
    [[nodiscard]] Frame frame_of(const Telegram& request) const override;
    [[nodiscard]] Telegram mark_of(const Telegram& t) const override { return {t.address, t.axis, t.item, Telegram::Kind::read, {}}; }
    [[nodiscard]] bool answers(const Telegram& request, const Telegram& answer) const override;
    [[nodiscard]] drive::Reported reported(const Telegram& answer) const override;
    [[nodiscard]] Telegram probe(bool other) const override { return read(1, other ? "R02" : "R01"); }
    [[nodiscard]] std::string title(const Telegram* answer) const override;
    [[nodiscard]] Telegram poll(int channel) const override { return read(channel, "S00"); }
    [[nodiscard]] int learn(const Telegram& answer) override;
    [[nodiscard]] bool learn_rate(const Telegram& answer);
    // motion.cpp
    [[nodiscard]] Telegram stop(const Command& command) const override;
    [[nodiscard]] std::string plan(Job& job, Reason& reason) const override;
    [[nodiscard]] std::string plan_move(Job& job, const Move& move, Reason& reason) const;
    [[nodiscard]] std::string plan_native(Job& job, const Native& native, Reason& reason) const;
    void stepped(Job& job, const Telegram& answer) override;
    void acted(const CommandBody& body, AxisFeedback& axis) override;
    [[nodiscard]] std::string words_of(const Telegram& request) const override;

    [[nodiscard]] Telegram read(int channel, std::string item) const;
    [[nodiscard]] Telegram write(int channel, std::string item, std::int64_t value) const;
    int address_;
};

}  // namespace axisgate::example
