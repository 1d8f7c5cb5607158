// The adapter of LinMot drives: one line, several drives by ID, one exchange at a time. A drive sends only on request, so the line is free
// when its answer has arrived or has timed out. Only IDs of the setup are addressed, and a telegram of another ID is never taken for an
// answer.
#pragma once

#include <memory>
#include <string>

#include "adapters/linmot/drive.hpp"
#include "gateway/drive/line_adapter.hpp"

namespace axisgate::linmot {

/// Empty if `address` is the ID of a drive, 0..255, else what a valid address would be.
[[nodiscard]] std::string check_address(std::string_view address);

class LineAdapter final : public drive::TurnsAdapter<Drive> {
public:
    explicit LineAdapter(const Catalogue& of_family) : TurnsAdapter(bus_), bus_(of_family) {}

    void on_deadline(Instant now, Out& out) override;
    [[nodiscard]] Instant deadline() const override;

private:
    void take(const LineSetup& setup, Turn& t) override;
    void arrived(const Frame& frame, Turn& t) override;
    [[nodiscard]] std::string fault(const DriveSetup& drive, const LineSetup& line) const override;
    [[nodiscard]] std::unique_ptr<Drive> make(const DriveSetup& setup, std::size_t slot, Turn& t) override;
    void leaving(Drive& drive, Turn& t) override;
    void line_changed(Turn& t) override;
    void give(Turn& t) override;
    void received(const Telegram& telegram, Turn& t);
    void free_line();

    Bus bus_;
    Framer framer_;
    Drive* asked_ = nullptr;  ///< its answer is awaited
    Instant quiet_until_{};   ///< no request before that, on a line on which others speak
    Instant stop_from_{};     ///< and no stop before that
    Instant silent_at_{};     ///< the one of them that counts now
    bool waits_for_silence_ = false;
};

}  // namespace axisgate::linmot
