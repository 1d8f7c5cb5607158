// Adapter of the example drive: the line: who can be on it, and what arrives.
// In: setup, line state, commands, frames, time. Out: frames; feedback, results, links, notices. Never has two requests on the line.
#pragma once

#include "adapters/example/drive.hpp"
#include "gateway/drive/line_adapter.hpp"

namespace axisgate::example {

/// Empty if `address` is 1..99, else what would be right.
[[nodiscard]] std::string check_address(std::string_view address);

class LineAdapter final : public drive::TurnsAdapter<Drive> {
public:
    explicit LineAdapter(const Catalogue& catalogue) : TurnsAdapter(bus_), bus_(catalogue) {}

private:
    void take(const LineSetup& setup, Turn& t) override;
    void arrived(const Frame& frame, Turn& t) override;
    [[nodiscard]] std::string fault(const DriveSetup& drive, const LineSetup& line) const override;
    [[nodiscard]] std::unique_ptr<Drive> make(const DriveSetup& setup, std::size_t slot, Turn& t) override;

    drive::Bus bus_;
    drive::TextLines lines_ = lines();
};

}  // namespace axisgate::example
