// Adapter: one line of one family: Commands into Frames, Frames into Samples; it owns the line's discipline.
// In: setup, line state, commands, frames, the passing of time. Out: everything goes into Out; the next deadline is a result.
// Never has a clock, thread, socket or log. The same calls give the same results.
#pragma once

#include <vector>

#include "gateway/core/command.hpp"
#include "gateway/core/frame.hpp"
#include "gateway/core/sample.hpp"
#include "gateway/core/setup.hpp"

namespace axisgate {

/// What one call gave back. The caller clears it and uses it again, so that nothing is allocated in the steady state.
struct Out {
    struct Tx {
        Frame frame;
        Priority priority = Priority::command;
        Ticket order = no_ticket;  ///< the command for which it is sent; none: of the adapter's own accord
    };
    struct Feedback {
        AxisId axis = no_axis;
        AxisFeedback value;
    };
    /// The drive does not follow a streamed set-point: the stream is over.
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

/// What an adapter counted on its line since it was made.
struct AdapterCounters {
    std::uint64_t exchanges = 0;  ///< requests that got their answer
    std::uint64_t timeouts = 0;
    std::uint64_t retries = 0;
    std::uint64_t refused = 0;     ///< answers in which the drive said no
    std::uint64_t garbled = 0;     ///< bytes or frames that were not the protocol (bad CRC, bad length, unknown word)
    std::uint64_t unexpected = 0;  ///< well formed but nobody had asked

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
///  - every Command with a ticket gets exactly one Result, also when its drive is removed, the line goes down or nothing answers;
///  - a motion's `accepted` comes after a feedback with target_reached = false of that axis, and the drive's acknowledgement;
///  - nothing is sent to a drive that the setup does not name (group and global addresses excepted, where every receiver is named);
///  - urgent commands leave before everything that waits, after at most the exchange in progress;
///  - commands of one axis that are not urgent keep their order; an urgent one cancels the waiting motions of its axis (`interrupted`);
///  - a silent drive delays the others by at most one reply time-out per growing pause, and is heard again at its first answer;
///  - deadline() moves only by the calls below and is never before the instant of the last call, unless something is due now.
struct Adapter {
    /// Takes the wanted setup. Called first, and again whenever the site changes: drives that are the same go on undisturbed,
    /// removed ones end with their waiting commands failed, new ones begin unseen.
    virtual void configure(const LineSetup& setup, Instant now, Out& out) = 0;
    /// The line came up or went down. Down: everything in flight fails with Reason::line_down; up: drives begin unseen.
    virtual void on_line(bool up, Instant now, Out& out) = 0;
    /// Bodies that reach an adapter: all but ProcessData and Hand.
    virtual void on_command(const Command& command, Instant now, Out& out) = 0;
    /// The newest set-point of an axis, of a mode (8, 9 or 10) that the drive's catalogue offers. It waits for the line like a command,
    /// and a newer one takes its place; a command that moves or stops its axis takes it away. Without an answer: if the drive refuses it or
    /// does not answer, Out::stream_ends says so.
    virtual void on_set_point(const SetPoint& set_point, Instant /*now*/, Out& out) {
        out.stream_ends.push_back({set_point.axis, Reason::not_supported, "its adapter takes no streamed set-points"});
    }
    /// Of an axis whose drive follows each set-point within a time of its own (CiA 402's interpolation time period, 60C2): that time. What
    /// it is given next is bound by it and the site's limits: no further than the fastest allowed motion comes in it. 0: the drive makes
    /// its own ramps.
    [[nodiscard]] virtual Duration interpolation_time(AxisId /*axis*/) const { return {}; }
    virtual void on_frame(const Frame& frame, Instant now, Out& out) = 0;
    virtual void on_deadline(Instant now, Out& out) = 0;
    /// When on_deadline wants to be called; `never` if nothing is waited for.
    [[nodiscard]] virtual Instant deadline() const = 0;
    [[nodiscard]] virtual AdapterCounters counters() const = 0;
    virtual ~Adapter() = default;
};

}  // namespace axisgate
