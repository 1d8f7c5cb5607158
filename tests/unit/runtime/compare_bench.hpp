// A line of one family with its adapter and its twin in virtual time, whose frames are recorded as a file of any form that `axisgate
// compare` reads.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "gateway/engine/comparison.hpp"
#include "gateway/wire/twin_bus.hpp"

namespace axisgate::compare_test {

/// The families of the program; with `freedoms` (JSON, a list), the page of `family` has these in place of its own.
[[nodiscard]] const Families& families();
[[nodiscard]] Families families_with(const std::string& family, const std::string& freedoms);

class RecordedTwin final : private LineEvents {
public:
    struct Wish {
        std::string family, address;
        LineKind kind = LineKind::can;
        std::map<std::string, std::string> twin_options{};
        std::int64_t pushed = 0;  ///< the shaft is moved by hand to this position first
    };
    RecordedTwin(const Families& families, const Wish& wish);
    ~RecordedTwin() override;

    void run(Duration time);
    /// Gives a command to the adapter, and waits for its result.
    [[nodiscard]] Result ask(CommandBody body);
    [[nodiscard]] Result read(const std::string& parameter);
    [[nodiscard]] const std::vector<TraceEntry>& entries() const noexcept { return entries_; }

    /// candump's log without directions, for CAN.
    [[nodiscard]] std::string candump() const;
    /// "(SECONDS) > BYTES", for byte lines.
    [[nodiscard]] std::string hex() const;

private:
    void take(const Out& out);
    void on_frame(const Frame& frame) override;
    void on_line_state(bool up, const std::string& why) override;
    void on_sent(const Frame& frame) override;
    void note(const Frame& frame, bool to_drive);

    FamilyEntry family_;
    std::unique_ptr<TwinBus> bus_;
    std::unique_ptr<Adapter> adapter_;
    std::vector<TraceEntry> entries_;
    std::map<Ticket, Result> results_;
    Instant now_ = at_ns(1'000'000'000), begin_{};
    Ticket tickets_ = 0;
};

}  // namespace axisgate::compare_test
