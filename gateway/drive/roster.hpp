// Roster: the drives of one line: who stays, who goes and who is new when the site changes; and whose an axis is.
// In: the line's setup. Out: drives by slot and by axis. Never touches a drive that is the same in both setups.
// `Drive` has `const DriveSetup& setup() const` and `static constexpr int channels` (axes with a channel above are on no drive).
#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "gateway/core/adapter.hpp"
#include "gateway/drive/schedule.hpp"

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
        each([&](Drive& d) {
            for (const AxisSetup& a : d.setup().axes) {
                if (a.id != no_axis && a.channel >= 1 && a.channel <= Drive::channels) by_axis_.emplace_back(a.id, &d);
            }
        });
        std::ranges::sort(by_axis_, {}, [](const auto& p) { return p.first; });
        return fresh;
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

}  // namespace axisgate::drive
