// Adapter of the remote family: the axes of other gateways on one mirror line, each asked and told of by its GATEWAY/AXIS.
// In: setup, line state, commands, telegrams, time. Out: telegrams; feedback, results, links. Never waits for one axis with another: the
// line is a place in this process and carries what it is given.
#pragma once

#include "adapters/remote/drive.hpp"
#include "gateway/drive/roster.hpp"

namespace axisgate::remote {

class LineAdapter final : public Adapter {
public:
    explicit LineAdapter(const Catalogue& catalogue) : line_(catalogue) {}
    void configure(const LineSetup& setup, Instant now, Out& out) override;
    void on_line(bool up, Instant now, Out& out) override;
    void on_command(const Command& command, Instant now, Out& out) override;
    void on_frame(const Frame& frame, Instant now, Out& out) override;
    void on_deadline(Instant now, Out& out) override;
    [[nodiscard]] Instant deadline() const override;
    [[nodiscard]] AdapterCounters counters() const override { return line_.counters; }

private:
    Line line_;
    drive::Roster<Drive> drives_;
    mirror::Framer framer_;
    bool up_ = false;
};

}  // namespace axisgate::remote
