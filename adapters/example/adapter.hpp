// Adapter of the example drive: the line: who is on it, whose turn it is, what arrives.
// In: setup, line state, commands, frames, time. Out: frames; feedback, results, links, notices. Never has two requests on the line.
#pragma once

#include "adapters/example/drive.hpp"
#include "gateway/drive/roster.hpp"

namespace axisgate::example {

/// Empty if `address` is 1..99, else what would be right.
[[nodiscard]] std::string check_address(std::string_view address);

class LineAdapter final : public Adapter {
public:
    explicit LineAdapter(const Catalogue& catalogue) : line_(catalogue) {}
    void configure(const LineSetup& setup, Instant now, Out& out) override;
    void on_line(bool up, Instant now, Out& out) override;
    void on_command(const Command& command, Instant now, Out& out) override;
    void on_set_point(const SetPoint& set_point, Instant now, Out& out) override;
    void on_frame(const Frame& frame, Instant now, Out& out) override;
    void on_deadline(Instant now, Out& out) override;
    [[nodiscard]] Instant deadline() const override { return line_.turns.deadline(); }
    [[nodiscard]] AdapterCounters counters() const override { return line_.counters; }

private:
    Line line_;
    drive::Roster<Drive> drives_;
    Framer framer_;
    bool up_ = false;
};

}  // namespace axisgate::example
