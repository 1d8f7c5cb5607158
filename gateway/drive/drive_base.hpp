// DriveBase holds the members that the drives of all families have: setup and slot, presence, open tickets and notices. It sends nothing
// and decides nothing; the family derives from it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "gateway/core/catalogue.hpp"
#include "gateway/drive/notices.hpp"
#include "gateway/drive/presence.hpp"
#include "gateway/drive/tickets.hpp"
#include "gateway/drive/turn.hpp"

namespace axisgate::drive {

class DriveBase {
public:
    /// `channels` is the number of axes that a drive of this kind can have.
    DriveBase(const DriveSetup& of_site, const Timing& timing, std::size_t slot, int channels = 1, Tickets places = Tickets())
        : setup_(of_site), presence(of_site.id, timing), tickets(std::move(places)), slot_(slot), notices_(of_site.id) {
        for (const AxisSetup& a : of_site.axes)
            if (channels == 1 && a.channel == 1) axis_ = a.id;
    }
    DriveBase(const DriveBase&) = delete;
    DriveBase& operator=(const DriveBase&) = delete;

    [[nodiscard]] const DriveSetup& setup() const noexcept { return setup_; }
    [[nodiscard]] std::size_t slot() const noexcept { return slot_; }
    [[nodiscard]] const std::string& name() const noexcept { return setup_.name; }
    /// The only axis of the drive; no_axis if the drive can have several axes or the site defines none.
    [[nodiscard]] AxisId axis() const noexcept { return axis_; }
    /// The catalogue that numbers the drive's parameters: its own one, else the family's.
    [[nodiscard]] const Catalogue& catalogue_or(const Catalogue& page) const noexcept {
        return setup_.catalogue ? *setup_.catalogue : page;
    }
    [[nodiscard]] bool ready() const noexcept { return presence.is(Presence::Phase::ready); }

    void notice(Severity severity, std::string_view kind, std::int32_t code, std::string text, Turn& t, AxisId axis) {
        notices_.tell(severity, axis, kind, code, std::move(text), t.now, t.out);
    }
    /// A notice of the only axis, or of the drive as a whole.
    void notice(Severity severity, std::string_view kind, std::int32_t code, std::string text, Turn& t) {
        notice(severity, kind, code, std::move(text), t, axis_);
    }
    /// Reports options of the drive that could not be read.
    void tell_setup(const std::vector<std::string>& faults, Turn& t) {
        for (const std::string& fault : faults)
            notice(Severity::warning, "setup", 0, fault, t);
    }

protected:
    ~DriveBase() = default;
    DriveSetup setup_;

public:
    Presence presence;
    Tickets tickets;

private:
    AxisId axis_ = no_axis;
    std::size_t slot_;
    Notices notices_;
};

}  // namespace axisgate::drive
