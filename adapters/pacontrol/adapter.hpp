// Adapter of the PA-CONTROL: one serial line, one control on it, with up to 16 axes.
// In: setup, line state, commands, bytes, time. Out: frames; feedback, samples, results, links, notices.
// The port is point to point and knows no address: a second drive on the same line is told that its place is taken.
#pragma once

#include <string>
#include <string_view>

#include "adapters/pacontrol/drive.hpp"
#include "gateway/drive/line_adapter.hpp"

namespace axisgate::pacontrol {

/// Empty if `address` is "com1", else what is wrong and what would be right.
[[nodiscard]] std::string check_address(std::string_view address);

class LineAdapter final : public drive::LineAdapter<Drive> {
public:
    LineAdapter(const Catalogue& of_family, LineKind) : bus_(of_family) {}

    void on_deadline(Instant now, Out& out) override;
    [[nodiscard]] Instant deadline() const override;
    [[nodiscard]] AdapterCounters counters() const override { return bus_.counters; }

private:
    void take(const LineSetup& setup, Turn& t) override;
    void arrived(const Frame& frame, Turn& t) override;
    [[nodiscard]] std::string fault(const DriveSetup& drive, const LineSetup& line) const override;
    [[nodiscard]] std::unique_ptr<Drive> make(const DriveSetup& setup, std::size_t slot, Turn& t) override;
    void line_changed(Turn&) override {}
    void settle(Drive&, Turn&) override {}
    void end(Turn& t) override;

    Bus bus_;
    Instant last_{};
};

}  // namespace axisgate::pacontrol
