// Device is the simulated drive on its line: LinRS telegrams, the simulated hand, and the interface Twin. It answers only telegrams that
// are addressed to it and understood. The effect of motion commands is in drive.hpp.
#pragma once

#include <deque>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "adapters/linmot/twin/shown_words.hpp"
#include "gateway/core/hand_table.hpp"
#include "gateway/core/twin.hpp"

namespace axisgate::linmot::twin {

struct DeviceSetup {
    std::uint8_t id = 0x11;
    DriveSetup drive;
    std::string checksum = "none";  ///< none, sum, crc, crc_reflected
    std::size_t checksum_from = 0;
    std::uint16_t checksum_start = 0xFFFF;
    std::map<std::uint16_t, std::string> error_texts;  ///< "Err: X4 Logic Supply Too Low"
};

class Device final : public Twin {
public:
    explicit Device(DeviceSetup setup) : setup_(std::move(setup)), drive_(setup_.drive), shown_(setup_.drive.manners) {}

    void on_frame(const Frame& frame, Instant now, Out& out) override;
    void on_deadline(Instant now, Out& out) override;
    [[nodiscard]] Instant deadline() const override;
    void power_on(const NonVolatile& memory, Instant now, Out& out) override;
    [[nodiscard]] NonVolatile non_volatile() const override;
    [[nodiscard]] std::uint64_t non_volatile_revision() const override { return drive_.memory.revision + revision_; }
    [[nodiscard]] std::vector<HandItem> hand() const override;
    [[nodiscard]] std::string set_hand(const std::string& name, const Value& value, Instant now, Out& out) override;
    [[nodiscard]] TwinMechanics mechanics(int channel, Instant now) const override;

    /// For tests.
    [[nodiscard]] Drive& drive() noexcept { return drive_; }

private:
    using Data = std::span<const std::uint8_t>;
    void look(Instant now, Out& out);
    void received(Data body, Instant now, Out& out);
    [[nodiscard]] const Manners& manners() const noexcept { return setup_.drive.manners; }
    void advance(Instant now) const { shown_.advance(drive_, now); }
    [[nodiscard]] bool heeds(std::uint8_t main, std::size_t size, Instant now) const;
    [[nodiscard]] std::vector<std::uint8_t> telegram(std::uint8_t id, std::span<const std::uint8_t> body) const;
    void send(std::span<const std::uint8_t> bytes, Instant at, Out& out, Priority priority = Priority::command) const;
    void answer(std::uint8_t sub, std::vector<std::uint8_t> data, Out& out) const;
    void answer_later(Duration time, const Out& answers);
    void unasked(Instant now, Out& out);
    void speak_foreign(Instant at, Out& out) const;
    void default_response(Out& out, std::span<const std::uint8_t> more = {}) const;
    void config(std::uint8_t sub, std::uint8_t state, std::uint16_t index, std::uint32_t value, Out& out) const;
    void parameters(std::uint8_t sub, Data data, Out& out);
    void curves(std::uint8_t sub, Data data, Out& out);
    void program(std::uint8_t sub, Instant now, Out& out);
    void errors(std::uint8_t sub, Data data, Out& out) const;
    void command_table(std::uint8_t sub, Data data, Out& out);
    [[nodiscard]] std::uint16_t sum(std::span<const std::uint8_t> bytes) const;
    void start(Instant now);
    void set_error_count();
    // hand.cpp
    static const HandRow<Device> conditions[];
    void switch_power(bool on, Instant now);
    template <class Change>
    std::string change_outside(Instant now, Change&& change);
    std::string set_outside(bool Outside::*member, const HandWish& wish);
    std::string set_outside(std::uint16_t Outside::*member, const HandWish& wish);
    std::string set_outside(std::int64_t Outside::*member, double factor, const HandWish& wish);
    bool set_x4(std::uint16_t bit, const HandWish& wish);

    DeviceSetup setup_;
    mutable Drive drive_;  ///< mechanics() advances it, without a visible change
    mutable ShownWords shown_;
    std::vector<std::uint8_t> held_;
    bool powered_ = false, silent_ = false;
    Instant deaf_until_{};
    Instant reply_at_ = never;  ///< of an answer that takes some time
    std::vector<std::uint8_t> reply_;
    static constexpr std::size_t most_slow = 16;  ///< further answers of slow jobs are lost
    std::deque<std::pair<Instant, Frame>> slow_;  ///< answers of jobs in the memory, in order of time
    Instant free_at_{};                           ///< requests before that are not heeded
    Instant foreign_at_ = never, unsolicited_at_ = never;
    std::map<std::uint16_t, TableEntry> table_flash_;
    std::map<std::uint16_t, Curve> curves_flash_;
    std::uint64_t revision_ = 0;
    std::uint16_t list_next_ = 0;
    bool list_open_ = false;
    std::uint16_t errors_seen_ = 0, last_error_ = 0;
    std::uint16_t block_id_ = 0;
    std::uint8_t block_sub_ = 0;
    std::size_t block_at_ = 0;
    std::map<std::uint16_t, std::pair<std::size_t, std::size_t>> block_sizes_;  ///< info and data of curves that are being written
    Instant last_byte_{}, at_{};                                                ///< of the telegram that is being answered
};

}  // namespace axisgate::linmot::twin
