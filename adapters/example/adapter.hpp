// The adapter of the example drive: which drives can be on the line, and what a received line means. One request is outstanding on the line
// at a time.
#pragma once

#include "adapters/example/drive.hpp"
#include "gateway/drive/line_adapter.hpp"

namespace axisgate::example {

/// Empty if `address` is 1..99, else what a valid address would be.
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
