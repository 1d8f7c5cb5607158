// Scans. Addresses that the site does not name are given to the line's adapter as drives without axes, a few at a time;
// its own search for a drive is the question, its DriveLink the answer.
// In: wishes, links, the passing of time. Out: reports. Bounds: one scan per line, 16 addresses of a family at once, 2 s per address, the
// wish's own limit. Never asks an address that the site has given to a drive, and ends when the site changes.
#pragma once

#include "gateway/engine/machine.hpp"

namespace axisgate::engine {

class Scans {
public:
    Scans(Machine& machine, Publisher& publisher, Speakers& speakers) : machine_(machine), publisher_(publisher), speakers_(speakers) {}
    /// Whether a drive is an address that a scan asks: no drive of the site.
    [[nodiscard]] static bool is_probe(DriveId id) noexcept;
    /// Empty: it has begun; else why not.
    [[nodiscard]] std::string start(LineId line, ScanWish wish, Instant now);
    void cancel(LineId line, Instant now);
    [[nodiscard]] ScanReport report(LineId line) const;
    void turn(LineUnit& unit, Instant now);
    static void answered(Side& side, const DriveLink& link);
    void end(LineUnit& unit, ScanReport::State state, std::string why, Instant now);

private:
    [[nodiscard]] std::string not_to_be_searched(const LineUnit& unit, const FamilyEntry& wanted, std::string_view name) const;

    Machine& machine_;
    Publisher& publisher_;
    Speakers& speakers_;
};

}  // namespace axisgate::engine
