// The adapter of the remote family: the axes of other gateways on one mirror line, each with the address GATEWAY/AXIS. The line is inside
// this process and has no transmission time, so the axes never wait for each other.
#pragma once

#include "adapters/remote/drive.hpp"
#include "gateway/drive/line_adapter.hpp"

namespace axisgate::remote {

class LineAdapter final : public drive::LineAdapter<Drive> {
public:
    explicit LineAdapter(const Catalogue& catalogue) : line_(catalogue) {}
    void on_deadline(Instant now, Out& out) override;
    [[nodiscard]] Instant deadline() const override;
    [[nodiscard]] AdapterCounters counters() const override { return line_.counters; }

private:
    void take(const LineSetup& setup, Turn& t) override { line_.take(setup, t.now); }
    void arrived(const Frame& frame, Turn& t) override;
    [[nodiscard]] std::string fault(const DriveSetup& drive, const LineSetup& line) const override;
    [[nodiscard]] std::unique_ptr<Drive> make(const DriveSetup& setup, std::size_t slot, Turn& t) override;
    void line_changed(Turn&) override { framer_.clear(); }
    void settle(Drive& d, Turn& t) override { d.go(t); }
    void end(Turn&) override {}

    Line line_;
    mirror::Framer framer_;
};

}  // namespace axisgate::remote
