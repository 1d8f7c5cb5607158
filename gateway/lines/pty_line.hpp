// PtyLine: a pseudo-terminal made by us, under a name of the user's choice: a serial port that any program can open.
// In: a path at which to put the link. Out: see StreamLine.
// Never overwrites anything but a link to a pseudo-terminal, links only where PtyPlaces lets it, and takes away at the end only its own.
// Bytes that are sent while nobody has the other side open are lost, as on a cable without a listener. A pseudo-terminal has no rate: with
// settings that name one, bytes pass both ways as slowly as over a serial port; what waits meanwhile is held by the send queue and by the
// terminal's own buffer, both bounded (a program that writes more is held up, as by a full port).
#pragma once

#include <string>

#include "gateway/core/line_uri.hpp"
#include "gateway/lines/byte_pace.hpp"
#include "gateway/lines/stream_line.hpp"

namespace axisgate {

/// Where links may be put. A site comes over the network from people who are not the owner of this machine's files.
struct PtyPlaces {
    std::string only_below{};  ///< folder; empty: anywhere, as the person at the machine wants it
    std::string never_in{};    ///< folder; empty: none
};

class PtyLine final : public StreamLine {
public:
    /// The pace to keep, as that of a serial port; a baud of 0: as fast as the other side takes and gives.
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
    Instant in_crossed_{};   // the last byte of the read in hand
    Instant in_handed_{};    // the last byte of the reads before it: none crosses before that
    std::string slave_;      // what the link points to; empty: there is no link of ours
    bool somebody_ = false;  // has the other side open
    asio::steady_timer watch_;
};

}  // namespace axisgate
