// LineAdapter implements the calls of core/adapter.hpp for all families: it finds the drive of each call, keeps the list of drives, and
// ends each call with `end`, so that a place on the line that has become free is used at once. The family says what the line has (`take`,
// `fault`, `make`) and what a frame means (`arrived`).
// Requirements for `Drive`: those of Roster; `line_up(t)`, `line_down(why, t)`, `remove(why, t)` (ends everything; its link is not
// reported), `submit(command, t)`; `set_axes(setup, t)` for drives with several axes; `follow(set_point)` for drives that follow streams.
#pragma once

#include <fmt/core.h>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>

#include "gateway/drive/bus.hpp"
#include "gateway/drive/roster.hpp"
#include "gateway/drive/tickets.hpp"

namespace axisgate::drive {

template <class Drive>
class LineAdapter : public Adapter {
public:
    void configure(const LineSetup& setup, Instant now, Out& out) override {
        Turn t{now, out};
        take(setup, t);
        if constexpr (requires(Drive & d, const DriveSetup& s) { d.set_axes(s, t); })
            drives_.fit_axes(setup, [&](Drive& d, const DriveSetup& s) { d.set_axes(s, t); });
        const auto gone = [&](Drive& d) {
            leaving(d, t);
            d.remove(fmt::format("drive {} was removed or changed", d.setup().name), t);
        };
        const auto fresh = drives_.fit(
            setup, gone, [&](const DriveSetup& s) { return fault(s, setup); },
            [&](const DriveSetup& s, std::size_t slot) { return make(s, slot, t); }, out);
        fitted();
        for (Drive* d : fresh)
            if (up_) d->line_up(t);
        changed(t);
    }
    void on_line(bool up, Instant now, Out& out) override {
        if (std::exchange(up_, up) == up) return;
        Turn t{now, out};
        line_changed(t);
        drives_.each([&](Drive& d) { up ? d.line_up(t) : d.line_down("the line is down", t); });
        changed(t);
    }
    void on_command(const Command& command, Instant now, Out& out) override {
        Turn t{now, out};
        Drive* d = drives_.of(command.axis);
        if (!d) return Tickets::refuse(command, Reason::line_down, nobody(), out);
        d->submit(command, t);
        settle(*d, t);
        end(t);
    }
    void on_frame(const Frame& frame, Instant now, Out& out) override {
        if (!up_) return;
        Turn t{now, out};
        arrived(frame, t);
        end(t);
    }
    void on_set_point(const SetPoint& p, Instant now, Out& out) override {
        if constexpr (requires(Drive & d) { d.follow(p); }) {
            Turn t{now, out};
            Drive* d = drives_.of(p.axis);
            if (!d) return;
            d->follow(p);
            settle(*d, t);
            end(t);
        } else {
            Adapter::on_set_point(p, now, out);
        }
    }

protected:
    /// Sets the timing and the options of the line.
    virtual void take(const LineSetup& setup, Turn& t) = 0;
    /// Returns why this drive cannot be on the line (its address is invalid or in use); empty if it can.
    [[nodiscard]] virtual std::string fault(const DriveSetup& drive, const LineSetup& line) const = 0;
    [[nodiscard]] virtual std::unique_ptr<Drive> make(const DriveSetup& setup, std::size_t slot, Turn& t) = 0;
    /// The drive is about to be removed; no pointer to it may be kept.
    virtual void leaving(Drive&, Turn&) {}
    /// The removed drives are gone and the new ones exist.
    virtual void fitted() {}
    /// The line came up or went down; the drives are informed after this call. Bytes of an incomplete message are lost.
    virtual void line_changed(Turn& t) = 0;
    /// A frame arrived while the line is up.
    virtual void arrived(const Frame& frame, Turn& t) = 0;
    /// The state of this drive may have changed.
    virtual void settle(Drive& drive, Turn& t) = 0;
    /// Called at the end of each call of the adapter.
    virtual void end(Turn& t) = 0;

    [[nodiscard]] bool up() const noexcept { return up_; }
    [[nodiscard]] Roster<Drive>& drives() noexcept { return drives_; }
    [[nodiscard]] const Roster<Drive>& drives() const noexcept { return drives_; }

private:
    void changed(Turn& t) {
        drives_.each([&](Drive& d) { settle(d, t); });
        end(t);
    }
    [[nodiscard]] static std::string nobody() {
        return fmt::format("this axis is not on the line, or its drive's address or channel is wrong (these drives have {})",
                           Drive::channels == 1 ? std::string("one axis") : fmt::format("channels 1 to {}", Drive::channels));
    }

    Roster<Drive> drives_;
    bool up_ = false;
};

/// An adapter whose drives take turns on the line. The family adds `arrived`. `Drive` must meet the requirements of `settle`, `serve` and
/// `wake`.
template <class Drive>
class TurnsAdapter : public LineAdapter<Drive> {
public:
    /// `bus` belongs to the family and lives as long as this object.
    explicit TurnsAdapter(Bus& bus) noexcept : shared_(bus) {}
    void on_deadline(Instant now, Out& out) override {
        Turn t{now, out};
        wake(shared_.turns, this->drives(), t);
        end(t);
    }
    [[nodiscard]] Instant deadline() const override { return this->up() ? std::max(shared_.turns.deadline(), looked_at_) : never; }
    [[nodiscard]] AdapterCounters counters() const override { return shared_.counters; }

protected:
    void leaving(Drive& d, Turn&) override { shared_.turns.remove(d.slot()); }
    void fitted() override { shared_.turns.forget_wishes(); }
    void line_changed(Turn& t) override { shared_.turns.line_changed(t.now); }
    void settle(Drive& d, Turn& t) override { drive::settle(shared_.turns, d, t.now); }
    void end(Turn& t) final {
        looked_at_ = t.now;
        if (this->up()) give(t);
    }
    /// Gives every free place of the line to a drive.
    virtual void give(Turn& t) { serve(shared_.turns, this->drives(), t); }

private:
    Bus& shared_;
    Instant looked_at_{};  ///< deadlines until then have been handled: the reported deadline is not earlier
};

}  // namespace axisgate::drive
