// Adapter of the PA-CONTROL: one serial line, one control on it, with up to 16 axes.
// In: setup, line state, commands, bytes, time. Out: frames; feedback, samples, results, links, notices.
// The port is point to point and knows no address: a second drive on the same line is told that its place is taken.
#pragma once

#include <string>
#include <string_view>

#include "adapters/pacontrol/drive.hpp"
#include "gateway/core/adapter.hpp"
#include "gateway/drive/roster.hpp"

namespace axisgate::pacontrol {

/// Empty if `address` is "com1", else what is wrong and what would be right.
[[nodiscard]] std::string check_address(std::string_view address);

class LineAdapter final : public Adapter {
public:
    LineAdapter(const Catalogue& of_family, LineKind on);

    void configure(const LineSetup& setup, Instant now, Out& out) override;
    void on_line(bool up, Instant now, Out& out) override;
    void on_command(const Command& command, Instant now, Out& out) override;
    void on_frame(const Frame& frame, Instant now, Out& out) override;
    void on_deadline(Instant now, Out& out) override;
    [[nodiscard]] Instant deadline() const override;
    [[nodiscard]] AdapterCounters counters() const override { return counters_; }

private:
    void read_form(const LineSetup& setup, Turn& t);
    void pump(Turn& t);

    const Catalogue& catalogue_;
    const Elements elements_;
    AdapterCounters counters_;
    LineForm line_;
    drive::Roster<Drive> drives_;  ///< one at most: the port is point to point
    bool up_ = false;
    Instant last_{};
};

}  // namespace axisgate::pacontrol
