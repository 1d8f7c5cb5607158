// Roster is the list of the drives of one line. When the site changes, it decides which drives remain, go or are new; it finds the drive of
// an axis. A drive that is equal in both setups is not touched.
// Requirements for `Drive`: `const DriveSetup& setup() const`; `void look(const DriveSetup&)`, called at each change (how closely its axes
// are observed); `static constexpr int channels` (an axis with a higher channel belongs to no drive).
#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "gateway/core/adapter.hpp"
#include "gateway/drive/turn.hpp"
#include "gateway/drive/turns.hpp"

namespace axisgate::drive {

/// The same drive with the same axes and options: it is not disturbed.
[[nodiscard]] bool same_drive(const DriveSetup& a, const DriveSetup& b);

template <class Drive>
class Roster {
public:
    /// Removes removed and changed drives first, so that their addresses are free; `removed(drive)` ends their commands. For each new
    /// drive, `fault(setup)` returns why it cannot be on this line (invalid address, or address in use), which is reported as its link; if
    /// it returns an empty text, `make(setup, slot)` creates the drive. Returns the new drives.
    template <class Removed, class Fault, class Make>
    std::vector<Drive*> fit(const LineSetup& setup, Removed&& removed, Fault&& fault, Make&& make, Out& out) {
        for (auto& d : drives_) {
            if (!d || std::ranges::any_of(setup.drives, [&](const DriveSetup& s) { return same_drive(s, d->setup()); })) continue;
            removed(*d);
            d.reset();
        }
        std::vector<Drive*> fresh;
        for (const DriveSetup& s : setup.drives) {
            if (std::ranges::any_of(drives_, [&](const auto& d) { return d && same_drive(s, d->setup()); })) continue;
            std::size_t slot = 0;
            while (slot < drives_.size() && drives_[slot])
                ++slot;
            std::string why = slot >= slot_limit ? std::string("a line has at most 256 drives") : fault(s);
            if (!why.empty()) {
                out.links.push_back({s.id, false, 0, Duration{}, std::move(why)});
                continue;
            }
            if (slot == drives_.size()) drives_.emplace_back();
            drives_[slot] = make(s, slot);
            fresh.push_back(drives_[slot].get());
        }
        by_axis_.clear();
        for (const DriveSetup& s : setup.drives) {
            each([&](Drive& d) {
                if (same_drive(s, d.setup())) d.look(s);
            });
        }
        each([&](Drive& d) {
            for (const AxisSetup& a : d.setup().axes) {
                if (a.id != no_axis && a.channel >= 1 && a.channel <= Drive::channels) by_axis_.emplace_back(a.id, &d);
            }
        });
        std::ranges::sort(by_axis_, {}, [](const auto& p) { return p.first; });
        return fresh;
    }

    /// For drives with several axes, before `fit`: a drive that differs in its axes only remains, and `axes_changed(drive, setup)` gives it
    /// the new setup.
    template <class AxesChanged>
    void fit_axes(const LineSetup& setup, AxesChanged&& axes_changed) {
        each([&](Drive& d) {
            for (DriveSetup s : setup.drives) {
                if (same_drive(s, d.setup())) return;
                const DriveSetup wanted = s;
                s.axes = d.setup().axes;
                if (same_drive(s, d.setup())) return axes_changed(d, wanted);
            }
        });
    }

    /// nullptr: the axis belongs to no drive.
    [[nodiscard]] Drive* of(AxisId axis) const noexcept {
        const auto it = std::ranges::lower_bound(by_axis_, axis, {}, [](const auto& p) { return p.first; });
        return it != by_axis_.end() && it->first == axis ? it->second : nullptr;
    }
    [[nodiscard]] Drive* at(std::size_t slot) const noexcept { return slot < drives_.size() ? drives_[slot].get() : nullptr; }
    /// Calls `f` in order of slots.
    template <class F>
    void each(F&& f) const {
        for (const auto& d : drives_) {
            if (d) f(*d);
        }
    }
    /// The first drive for which `is(drive)` is true; nullptr if there is none.
    template <class Is>
    [[nodiscard]] Drive* find(Is&& is) const {
        for (const auto& d : drives_) {
            if (d && is(*d)) return d.get();
        }
        return nullptr;
    }

private:
    std::vector<std::unique_ptr<Drive>> drives_;  ///< by slot; free places are nullptr
    std::vector<std::pair<AxisId, Drive*>> by_axis_;
};

// The connection of Turns and Roster in an adapter. Requirements for a drive: `slot()`, `wants(now)`, `deadline()` (of an outstanding
// exchange), `wish()` (when it will have something to send), `go(t)` (it has a place on the line: it sends, or its wants(now) becomes
// nothing) and `on_deadline(t)`.

/// To be called after each change of a drive.
template <class Drive>
void settle(Turns& turns, const Drive& drive, Instant now) {
    turns.settle(drive.slot(), drive.wants(now), drive.deadline(), drive.wish());
}
/// Gives every free place to a drive. To be called at the end of each call of the adapter.
template <class Drive>
void serve(Turns& turns, const Roster<Drive>& drives, Turn& t) {
    while (const auto slot = turns.next(t.now)) {
        Drive* d = drives.at(*slot);
        if (!d) continue;
        d->go(t);
        settle(turns, *d, t.now);
    }
}
/// Calls each drive whose deadline has expired, once.
template <class Drive>
void wake(Turns& turns, const Roster<Drive>& drives, Turn& t) {
    for (std::size_t n = 0; n < slot_limit; ++n) {
        const auto slot = turns.due(t.now);
        if (!slot) return;
        drives.at(*slot)->on_deadline(t);
        settle(turns, *drives.at(*slot), t.now);
    }
}

}  // namespace axisgate::drive
