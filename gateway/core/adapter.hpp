// The interface of an adapter: one line of one family. It makes frames of commands and feedback of frames, and decides whose turn on the
// line it is. It has no clock, thread, socket or log: everything that a call causes is put into Out, and the next deadline is a result. The
// same calls give the same results.
#pragma once

#include <vector>

#include "gateway/core/command.hpp"
#include "gateway/core/frame.hpp"
#include "gateway/core/sample.hpp"
#include "gateway/core/setup.hpp"

namespace axisgate {

/// The output of one call. The caller clears it and uses it again, so that no memory is allocated in the steady state.
struct Out {
    struct Tx {
        Frame frame;
        Priority priority = Priority::command;
        Ticket order = no_ticket;  ///< the command for which it is sent; none: a poll or another action of the adapter
    };
    struct Feedback {
        AxisId axis = no_axis;
        AxisFeedback value;
    };
    /// The drive does not follow a streamed set-point, so the stream ends.
    struct StreamEnd {
        AxisId axis = no_axis;
        Reason reason = Reason::drive_refused;
        std::string text;  ///< for people
    };
    std::vector<Tx> frames;
    std::vector<Feedback> feedback;
    std::vector<Sample> samples;
    std::vector<Result> results;
    std::vector<DriveLink> links;
    std::vector<Notice> notices;
    std::vector<StreamEnd> stream_ends;

    void clear() noexcept {
        frames.clear();
        feedback.clear();
        samples.clear();
        results.clear();
        links.clear();
        notices.clear();
        stream_ends.clear();
    }
    void send(const Frame& frame, Priority priority = Priority::command, Ticket order = no_ticket) {
        frames.push_back({frame, priority, order});
    }
};

/// The numbers that an adapter has counted on its line since it was made.
struct AdapterCounters {
    std::uint64_t exchanges = 0;  ///< requests that were answered
    std::uint64_t timeouts = 0;
    std::uint64_t retries = 0;
    std::uint64_t refused = 0;     ///< answers in which the drive refused
    std::uint64_t garbled = 0;     ///< bytes or frames that violate the protocol (wrong CRC, wrong length, unknown word)
    std::uint64_t unexpected = 0;  ///< correct frames without a request

    AdapterCounters& operator+=(const AdapterCounters& o) noexcept {
        exchanges += o.exchanges;
        timeouts += o.timeouts;
        retries += o.retries;
        refused += o.refused;
        garbled += o.garbled;
        unexpected += o.unexpected;
        return *this;
    }
};

/// Laws (tests/conformance checks them for every family):
///  - every Command with a ticket gets exactly one Result, also when its drive is removed, the line goes down or no answer comes;
///  - a motion's `accepted` comes after a feedback with target_reached = false of that axis, and the drive's acknowledgement;
///  - nothing is sent to a drive that the setup does not name (except group and global addresses, if every receiver is named);
///  - urgent commands leave before everything that waits, after at most the exchange in progress;
///  - commands of one axis that are not urgent keep their order; an urgent one cancels the waiting motions of its axis (`interrupted`);
///  - a silent drive delays the others by at most one reply time-out per growing pause, and is served again at its first answer;
///  - deadline() changes only by the calls below and is never before the instant of the last call, unless something is due now.
struct Adapter {
    /// Applies the wanted setup. Called first, and again whenever the site changes: unchanged drives continue undisturbed, waiting commands
    /// of removed ones fail, new ones begin as unseen.
    virtual void configure(const LineSetup& setup, Instant now, Out& out) = 0;
    /// The line came up or went down. Down: everything outstanding fails with Reason::line_down; up: drives begin as unseen.
    virtual void on_line(bool up, Instant now, Out& out) = 0;
    /// All bodies reach an adapter except ProcessData and Hand.
    virtual void on_command(const Command& command, Instant now, Out& out) = 0;
    /// The newest set-point of an axis, of a mode (8, 9 or 10) that the drive's catalogue offers. It waits for the line like a command, and
    /// a newer one replaces it; a command that moves or stops its axis removes it. There is no answer: if the drive refuses it or does not
    /// answer, Out::stream_ends reports this.
    virtual void on_set_point(const SetPoint& set_point, Instant /*now*/, Out& out) {
        out.stream_ends.push_back({set_point.axis, Reason::not_supported, "its adapter takes no streamed set-points"});
    }
    /// For an axis whose drive follows each set-point within a fixed time (CiA 402's interpolation time period, 60C2): that time. The next
    /// set-point is then limited to the distance of the fastest allowed motion in it. 0: the drive makes its own ramps.
    [[nodiscard]] virtual Duration interpolation_time(AxisId /*axis*/) const { return {}; }
    virtual void on_frame(const Frame& frame, Instant now, Out& out) = 0;
    virtual void on_deadline(Instant now, Out& out) = 0;
    /// When on_deadline must be called; `never` if nothing is waited for.
    [[nodiscard]] virtual Instant deadline() const = 0;
    [[nodiscard]] virtual AdapterCounters counters() const = 0;
    virtual ~Adapter() = default;
};

}  // namespace axisgate
