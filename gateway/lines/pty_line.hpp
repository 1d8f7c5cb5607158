// PtyLine: a pseudo-terminal created by the gateway under a name that the user chooses: a serial port that any program can open.
// The link replaces nothing but another link to a pseudo-terminal, is created only where PtyPlaces permits it, and is removed at the
// end only if it is still ours. Bytes that are sent while no program has the port open are lost, as on a cable without a listener. A
// pseudo-terminal has no bit rate: with settings that name one, bytes pass in both directions at that rate. Waiting bytes are held in
// the send queue and in the terminal's own buffer, both bounded; a program that writes more is blocked, as by a full port.
#pragma once

#include <string>

#include "gateway/core/line_uri.hpp"
#include "gateway/lines/byte_pace.hpp"
#include "gateway/lines/stream_line.hpp"

namespace axisgate {

/// Where links may be created. A site is received over the network, from people who do not own the files of this machine.
struct PtyPlaces {
    std::string only_below{};  ///< folder; empty: anywhere, for a user at the machine itself
    std::string never_in{};    ///< folder; empty: none
};

class PtyLine final : public StreamLine {
public:
    /// `pace_baud` and `pace_format` set the pace, as those of a serial port; with a baud of 0, bytes pass as fast as both sides allow.
    PtyLine(const LineBase& base, std::string path, std::uint32_t pace_baud = 0, const SerialFormat& pace_format = {},
            PtyPlaces places = {});
    ~PtyLine() override { close(); }

private:
    void start() override;
    void stop() override;
    void flush() override;
    void on_gone(int error) override;
    [[nodiscard]] std::size_t room_to_write() override { return std::min(out_.room(clock().now()), chunk); }
    [[nodiscard]] Duration pause_before_write() const override { return out_.pause(clock().now()); }
    void wrote(std::size_t bytes, bool more) override { out_.pass(bytes, more, clock().now()); }
    [[nodiscard]] std::size_t room_to_read() override { return std::min(in_.room(clock().now()), chunk); }
    [[nodiscard]] Duration pause_before_read() const override { return in_.pause(clock().now()); }
    void got(std::size_t bytes, bool more) override;
    [[nodiscard]] Instant crossed(std::size_t before_the_last) const override;
    [[nodiscard]] std::size_t run() const override { return in_.active() ? std::min(in_.grain(), Frame::capacity) : Frame::capacity; }
    [[nodiscard]] std::string up_text() const override;
    void watch_for_somebody();

    std::string path_;
    PtyPlaces places_;
    std::uint32_t pace_baud_;
    SerialFormat pace_format_;
    BytePace out_, in_;
    Instant in_crossed_{};   // when the last byte of the present read had crossed
    Instant in_handed_{};    // the same for the reads before it: no byte crosses before that
    std::string slave_;      // target of our link; empty: there is no link of ours
    bool somebody_ = false;  // a program has the port open
    asio::steady_timer watch_;
};

}  // namespace axisgate
