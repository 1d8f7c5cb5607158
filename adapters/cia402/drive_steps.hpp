// Steps: a command taken apart into transfers with one node, and what one of them is for.
// In and out: values. Addresses are those of the first axis: the node that sends them shifts objects of the profile to their axis.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "adapters/cia402/wire.hpp"
#include "gateway/core/command.hpp"
#include "gateway/core/instant.hpp"
#include "gateway/protocols/canopen/nmt.hpp"

namespace axisgate::cia402_drive {

/// Drives look at their control word once in 1 to 10 ms: what did not stand for so long may not have been seen.
inline constexpr Duration seen_by_all = std::chrono::milliseconds(12);

inline constexpr std::uint16_t start_bit = 0x10;  ///< of the control word

struct Step {
    /// What an `until` waits for, where that is more than a value under a mask.
    enum class Awaits : std::uint8_t {
        value,
        mode,         ///< 6061h shows the mode that 6060h has ordered
        release,      ///< status bit 12 is gone: the next set-point may come
        acknowledge,  ///< status bit 12: the set-point is taken
        homing        ///< the search has begun, or has ended already
    };
    enum class Kind : std::uint8_t { read, write, until, nmt } kind = Kind::read;
    Address address;
    std::vector<std::uint8_t> bytes;   ///< what is written
    std::uint32_t mask = 0, want = 0;  ///< until: the value under the mask is this one
    bool optional = false;             ///< a refusal is no reason to stop
    bool from_here = false;            ///< write: the bytes are a distance from the position that the step before read
    bool literal = false;              ///< the address is that of the node, whose axis it may be
    bool edge = false;                 ///< write: bit 4 rises, for which the drive must have seen it low
    Awaits awaits = Awaits::value;
    std::optional<std::int64_t> away_from{};      ///< until: the value is nearer to `want` than to this one
    Duration patience = std::chrono::seconds(2);  ///< until
    canopen::NmtCommand nmt = canopen::NmtCommand::start;
};

/// A command on its way.
struct Job {
    Command command;
    std::vector<Step> steps;
    std::size_t at = 0;
    Instant wait_until{};  ///< the next look
    Instant give_up = never;
    bool stream = false;
    std::int64_t here = 0;  ///< what was read last
    std::vector<std::uint8_t> data;
    bool released = false;          ///< the drive has shown that it has seen bit 4 low
    bool begun = false;             ///< a homing: it was seen under way
    bool turned = false;            ///< the axis moved already when the set-point went
    std::uint16_t status = 0;       ///< before a homing
    std::int64_t from = 0;          ///< where the axis was when the set-point went
    std::optional<Instant> went{};  ///< the word with the start bit
    std::string text;               ///< what the answer says besides

    void write(Address a, std::int64_t v, std::size_t size, bool optional = false) {
        steps.push_back({Step::Kind::write, a, bytes_of(v, size), 0, 0, optional});
    }
    void read(Address a) { steps.push_back({Step::Kind::read, a, {}}); }
    void word(std::uint16_t controlword) { write(object::controlword, controlword, 2); }
    void until(std::uint32_t mask, std::uint32_t want) { steps.push_back({Step::Kind::until, object::statusword, {}, mask, want}); }
    /// Bit 4 rises: not before the drive has surely seen it low.
    void start_word(std::uint16_t controlword) {
        word(controlword);
        steps.back().edge = true;
    }
    void await(Step::Awaits what, Address address, std::uint32_t mask, std::uint32_t want, Duration patience) {
        Step s{Step::Kind::until, address, {}, mask, want};
        s.awaits = what;
        s.patience = patience;
        steps.push_back(std::move(s));
    }
    /// Until it stands still, for as long as `patience`; a drive that does not tell its velocity is not waited for.
    void until_standstill(Duration patience = std::chrono::seconds(2)) {
        await(Step::Awaits::value, object::velocity, 0xFFFFFFFFu, 0, patience);
        steps.back().optional = true;
    }
    /// Until the actual position is `there` rather than `before`: an axis in a control loop is never quite on it.
    void until_position(std::int64_t there, std::int64_t before) {
        Step s{Step::Kind::until, object::position, {}, 0xFFFFFFFFu, static_cast<std::uint32_t>(there)};
        s.away_from = before;
        steps.push_back(std::move(s));
    }
};

/// One transfer, and who wants its answer.
struct Ask {
    enum class Why : std::uint8_t { probe, start, check, error, turns, rates, flush, step, stop } why = Why::probe;
    Step step;
    Ticket ticket = no_ticket;
    int left = 0;          ///< repeats
    std::size_t axis = 0;  ///< place of the one that asks, among the axes of the node
};

}  // namespace axisgate::cia402_drive
