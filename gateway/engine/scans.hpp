// Scans searches for drives at addresses that the site does not name. A few of them at a time are given to the line's adapter as drives
// without axes; the adapter's own search is the question, and its DriveLink is the answer. Bounds: one scan per line, 16 addresses of a
// family at once, 2 s per address, and the limit of the request. A scan ends when the site changes.
#pragma once

#include "gateway/engine/machine.hpp"

namespace axisgate::engine {

class Scans {
public:
    Scans(Machine& machine, Publisher& publisher, Speakers& speakers) : machine_(machine), publisher_(publisher), speakers_(speakers) {}
    /// True if the drive is an address that a scan asks, and not a drive of the site.
    [[nodiscard]] static bool is_probe(DriveId id) noexcept;
    /// Empty if the scan has begun, otherwise the reason why not.
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
