// Adapter of the LinMot drives: one line, several drives by ID, one exchange at a time.
// In: setup, line state, commands, bytes, time. Out: bytes; feedback, samples, results, links, notices.
// The drive speaks only when asked, so the line is free when its answer is here or given up.
// Never sends to an ID that the setup does not name, and never takes a telegram of another ID for an answer.
#pragma once

#include <memory>
#include <string>

#include "adapters/linmot/drive.hpp"
#include "gateway/core/adapter.hpp"
#include "gateway/drive/roster.hpp"
#include "gateway/drive/turns.hpp"

namespace axisgate::linmot {

class LineAdapter final : public Adapter {
public:
    explicit LineAdapter(const Catalogue& of_family);

    void configure(const LineSetup& setup, Instant now, Out& out) override;
    void on_line(bool up, Instant now, Out& out) override;
    void on_command(const Command& command, Instant now, Out& out) override;
    void on_set_point(const SetPoint& set_point, Instant now, Out& out) override;
    void on_frame(const Frame& frame, Instant now, Out& out) override;
    void on_deadline(Instant now, Out& out) override;
    [[nodiscard]] Instant deadline() const override;
    [[nodiscard]] AdapterCounters counters() const override { return bus_.counters; }

private:
    void take_manners(const LineSetup& setup, Turn& t);
    void settle(Drive& drive, Turn& t);
    void pump(Turn& t);
    void heard(const Telegram& telegram, Turn& t);
    void free_line();

    Bus bus_;
    Framer framer_;
    drive::Roster<Drive> roster_;
    drive::Turns turns_;
    Drive* asked_ = nullptr;  ///< whose answer is waited for
    bool up_ = false;
    Instant last_{};
};

}  // namespace axisgate::linmot
