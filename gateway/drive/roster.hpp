// Roster: the drives of one line: who stays, who goes and who is new when the site changes; and whose an axis is.
// In: the line's setup. Out: drives by slot and by axis. Never touches a drive that is the same in both setups.
// `Drive` has `const DriveSetup& setup() const`, `void look(const DriveSetup&)` (how closely its axes are looked at, told each time) and
// `static constexpr int channels` (axes with a channel above are on no drive).
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

/// The same drive with the same axes and options: it goes on undisturbed.
[[nodiscard]] bool same_drive(const DriveSetup& a, const DriveSetup& b);

template <class Drive>
class Roster {
public:
    /// Removed and changed ones first, so that their addresses are free: `removed(drive)` ends what is theirs. Then for each new one
    /// `fault(setup)`: empty, or why it cannot be on this line (its address is none, or another's), which is told as its link; else
    /// `make(setup, slot)` builds it. Returns the new ones.
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

    /// For drives with several axes, before `fit`: one that is the same but for its axes goes on. `axes_changed(drive, setup)` makes the
    /// new setup its own.
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

    /// nullptr: nobody.
    [[nodiscard]] Drive* of(AxisId axis) const noexcept {
        const auto it = std::ranges::lower_bound(by_axis_, axis, {}, [](const auto& p) { return p.first; });
        return it != by_axis_.end() && it->first == axis ? it->second : nullptr;
    }
    [[nodiscard]] Drive* at(std::size_t slot) const noexcept { return slot < drives_.size() ? drives_[slot].get() : nullptr; }
    /// In order of slots.
    template <class F>
    void each(F&& f) const {
        for (const auto& d : drives_) {
            if (d) f(*d);
        }
    }
    /// The first that `is(drive)`; nullptr: none.
    template <class Is>
    [[nodiscard]] Drive* find(Is&& is) const {
        for (const auto& d : drives_) {
            if (d && is(*d)) return d.get();
        }
        return nullptr;
    }

private:
    std::vector<std::unique_ptr<Drive>> drives_;  ///< by slot; empty places are nullptr
    std::vector<std::pair<AxisId, Drive*>> by_axis_;
};

// What an adapter does with the two of them. A drive has `slot()`, `wants(now)`, `deadline()` (of what it waits for), `wish()` (when it
// will want something without being asked), `go(t)` (it has a place: it sends, or wants nothing any more) and `on_deadline(t)`.

/// After anything has happened to a drive.
template <class Drive>
void settle(Turns& turns, const Drive& drive, Instant now) {
    turns.settle(drive.slot(), drive.wants(now), drive.deadline(), drive.wish());
}
/// Gives every free place away. The end of each call from outside.
template <class Drive>
void serve(Turns& turns, const Roster<Drive>& drives, Turn& t) {
    while (const auto slot = turns.next(t.now)) {
        Drive* d = drives.at(*slot);
        if (!d) continue;
        d->go(t);
        settle(turns, *d, t.now);
    }
}
/// Looks at each drive whose deadline has come, once.
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
