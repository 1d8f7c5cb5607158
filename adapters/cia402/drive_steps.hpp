// The steps of a command: transfers with one node, and the purpose of each. Addresses are those of the first axis; the node that sends them
// moves objects of the profile to the addresses of the axis.
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

/// Drives read their control word every 1 to 10 ms: a value that was present for a shorter time may not have been seen.
inline constexpr Duration seen_by_all = std::chrono::milliseconds(12);

inline constexpr std::uint16_t start_bit = 0x10;  ///< of the control word

struct Step {
    /// The condition of an `until` step, if it is more than a value under a mask.
    enum class Awaits : std::uint8_t {
        value,
        mode,         ///< 6061h shows the mode that 6060h has ordered
        release,      ///< status bit 12 is 0: the drive accepts the next set-point
        acknowledge,  ///< status bit 12: the drive has accepted the set-point
        homing,       ///< homing is in progress, or has ended already
        off           ///< the drive shows that operation has ended: the steps are planned anew by the state that it shows then
    };
    enum class Kind : std::uint8_t { read, write, until, nmt } kind = Kind::read;
    Address address;
    std::vector<std::uint8_t> bytes;   ///< value to be written
    std::uint32_t mask = 0, want = 0;  ///< until: the value under the mask equals `want`
    bool optional = false;             ///< the job continues if the drive refuses this step
    bool from_here = false;            ///< write: the bytes are a distance from the position that the step before has read
    bool literal = false;              ///< the address is used as it is, without the offset of the axis
    bool edge = false;                 ///< write: rising edge of bit 4; the drive must have seen 0 before
    Awaits awaits = Awaits::value;
    std::optional<std::int64_t> away_from{};      ///< until: the value is nearer to `want` than to this one
    Duration patience = std::chrono::seconds(2);  ///< of an until step
    canopen::NmtCommand nmt = canopen::NmtCommand::start;
    bool seen = false;  ///< write: the next step waits until a drive that samples its control word slowly has seen this one
};

/// A command in progress.
struct Job {
    Command command;
    std::vector<Step> steps;
    std::size_t at = 0;
    Instant wait_until{};  ///< time of the next read
    Instant give_up = never;
    bool stream = false;
    std::int64_t here = 0;                      ///< the last value that was read
    std::optional<std::int64_t> counts_from{};  ///< of a relative move; empty: from the actual position
    std::vector<std::uint8_t> data;
    bool released = false;          ///< the drive has shown that it has seen bit 4 at 0
    bool begun = false;             ///< homing was seen in progress
    bool mode_again = false;        ///< the mode was ordered a second time
    bool planned_anew = false;      ///< the drive was in another state than its last report said
    bool turned = false;            ///< the axis was already moving when the set-point was sent
    std::uint16_t status = 0;       ///< status word before homing
    std::int64_t from = 0;          ///< position of the axis when the set-point was sent
    std::optional<Instant> went{};  ///< when the control word with the start bit was sent
    std::string text;               ///< addition to the answer

    void write(Address a, std::int64_t v, std::size_t size, bool optional = false) {
        steps.push_back({Step::Kind::write, a, bytes_of(v, size), 0, 0, optional});
    }
    void read(Address a) { steps.push_back({Step::Kind::read, a, {}}); }
    void word(std::uint16_t controlword) { write(object::controlword, controlword, 2); }
    void word_seen(std::uint16_t controlword) {
        word(controlword);
        steps.back().seen = true;
    }
    void until(std::uint32_t mask, std::uint32_t want) { steps.push_back({Step::Kind::until, object::statusword, {}, mask, want}); }
    /// Rising edge of bit 4, not before the drive has certainly seen it at 0.
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
    /// Waits for standstill, at most `patience`. If the drive does not report its velocity, there is no wait.
    void until_standstill(Duration patience = std::chrono::seconds(2)) {
        await(Step::Awaits::value, object::velocity, 0xFFFFFFFFu, 0, patience);
        steps.back().optional = true;
    }
    /// Waits until the actual position is nearer to `there` than to `before`: an axis in a control loop never reaches a position exactly.
    void until_position(std::int64_t there, std::int64_t before) {
        Step s{Step::Kind::until, object::position, {}, 0xFFFFFFFFu, static_cast<std::uint32_t>(there)};
        s.away_from = before;
        steps.push_back(std::move(s));
    }
};

/// One transfer, and the axis that needs its answer.
struct Ask {
    enum class Why : std::uint8_t { probe, start, check, error, turns, rates, flush, step, stop, poll } why = Why::probe;
    Step step;
    Ticket ticket = no_ticket;
    int left = 0;          ///< remaining repetitions
    std::size_t axis = 0;  ///< place of the requesting axis among the axes of the node
    bool once = false;     ///< a refusal is not tried again, although the node may only be busy
};

}  // namespace axisgate::cia402_drive
