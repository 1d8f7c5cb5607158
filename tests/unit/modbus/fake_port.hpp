// The gateway for the Modbus door, without an engine: the test sets the axes and answers the commands. Time does not advance until the test
// moves it. The fuzz target uses it, too.
#pragma once

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "gateway/core/event.hpp"
#include "gateway/engine/door.hpp"

namespace axisgate::modbus::test {

class FakePort : public DoorPort {
public:
    /// Adds (or replaces) the axis with that number of the register map. edit() changes the picture.
    AxisId add_axis(std::uint16_t number, const Catalogue* catalogue = nullptr) {
        const AxisId id{next_id_++};
        if (!image_.grow(static_cast<std::size_t>(next_id_))) std::abort();
        image_.picture(id) = {};
        image_.picture(id).number = number;
        image_.publish(id);
        numbers_.resize(std::max<std::size_t>(numbers_.size(), number + std::size_t{1}), no_axis);
        numbers_[number] = id;
        image_.set_numbers(numbers_);
        catalogues_[id] = catalogue;
        return id;
    }
    void remove_axis(std::uint16_t number) {
        numbers_[number] = no_axis;
        image_.set_numbers(numbers_);
    }
    template <class Change>
    void edit(AxisId id, Change&& change) {
        change(image_.picture(id));
        image_.publish(id);
    }
    void set_mapping_revision(std::uint32_t revision) { image_.mapping_revision = revision; }

    /// Gives the result of the oldest unanswered command. Returns false if there is none.
    bool answer(Outcome outcome = Outcome::accepted, Reason reason = Reason::none, std::int32_t code = 0, Value value = {},
                std::string text = {}) {
        if (commands.empty()) return false;
        Command command = std::move(commands.front());
        commands.pop_front();
        if (outcome == Outcome::accepted || outcome == Outcome::done) apply(command);
        Result result;
        result.ticket = command.ticket;
        result.axis = command.axis;
        result.outcome = outcome;
        result.reason = reason;
        result.code = code;
        result.value = std::move(value);
        result.text = std::move(text);
        const DoorNumber number = door_of(result.ticket);
        if (number > 0 && number <= doors.size() && doors[number - 1u]) doors[number - 1u]->on_result(result);
        return true;
    }
    bool refuse(Reason reason, std::int32_t code = 0) { return answer(Outcome::refused, reason, code); }

    // --- DoorPort
    Instant now() const override { return time; }
    const Image& image() const override { return image_; }
    const Catalogue* catalogue(AxisId axis) const override {
        const auto it = catalogues_.find(axis);
        return it == catalogues_.end() ? nullptr : it->second;
    }
    void submit(Command command) override {
        ++submitted;
        commands.push_back(std::move(command));
    }
    std::optional<Refusal> set_point(const SetPoint&) override { return std::nullopt; }
    void note(Event&& event, AxisId axis) override { notes.emplace_back(std::move(event), axis); }
    DoorNumber attach(HotDoor& door) override {
        doors.push_back(&door);
        return static_cast<DoorNumber>(doors.size());
    }
    void detach(HotDoor& door) override { std::ranges::replace(doors, &door, nullptr); }

    void client_lost(const AuthorityClient& who, LossCause cause) override { lost.emplace_back(who.text(), cause); }

    std::vector<std::pair<std::string, LossCause>> lost;
    Instant time = at_ns(1'000'000'000'000);  // 1000 s
    std::deque<Command> commands;             // without a result
    std::size_t submitted = 0;
    std::vector<std::pair<Event, AxisId>> notes;  // in order
    std::vector<HotDoor*> doors;                  // by number - 1

private:
    /// Applies accepted set-points like an engine, so that they can be read back.
    void apply(const Command& command) {
        const auto* d = std::get_if<ProcessData>(&command.body);
        if (!d) return;
        edit(command.axis, [&](AxisPicture& p) {
            if (d->controlword) p.controlword = *d->controlword;
            if (d->mode) p.mode = *d->mode;
            if (d->target_position) p.target_position = *d->target_position;
            if (d->profile_velocity) p.profile_velocity = *d->profile_velocity;
            if (d->profile_acceleration) p.profile_acceleration = *d->profile_acceleration;
            if (d->profile_deceleration) p.profile_deceleration = *d->profile_deceleration;
            if (d->target_velocity) p.target_velocity = *d->target_velocity;
            if (d->homing_method) p.homing_method = *d->homing_method;
        });
    }

    Image image_;
    std::vector<AxisId> numbers_;
    std::map<AxisId, const Catalogue*> catalogues_;
    std::uint16_t next_id_ = 0;
};

/// "01 03 0A" -> bytes.
inline std::vector<std::uint8_t> bytes(std::string_view hex) {
    std::vector<std::uint8_t> out;
    std::string digits;
    for (const char c : hex) {
        if (c == ' ' || c == '\n') continue;
        digits += c;
        if (digits.size() == 2) {
            out.push_back(static_cast<std::uint8_t>(std::strtoul(digits.c_str(), nullptr, 16)));
            digits.clear();
        }
    }
    return out;
}
/// Bytes -> "01 03 0A".
template <class Bytes>
std::string hex(const Bytes& data) {
    std::string out;
    for (const std::uint8_t b : data) {
        char text[4];
        std::snprintf(text, sizeof text, "%02X ", b);
        out += text;
    }
    if (!out.empty()) out.pop_back();
    return out;
}
/// An ADU around a PDU, both as hex.
inline std::string adu(std::uint16_t transaction, std::string_view pdu, std::uint8_t unit = 1) {
    const auto body = bytes(pdu);
    std::vector<std::uint8_t> out{static_cast<std::uint8_t>(transaction >> 8),       static_cast<std::uint8_t>(transaction),     0,   0,
                                  static_cast<std::uint8_t>((body.size() + 1) >> 8), static_cast<std::uint8_t>(body.size() + 1), unit};
    out.insert(out.end(), body.begin(), body.end());
    return hex(out);
}

}  // namespace axisgate::modbus::test
