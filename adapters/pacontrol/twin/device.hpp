// The control on its serial port: frames in, acknowledgements out, the tester's hand, behind the Twin interface.
// In: bytes, time, the hand. Out: bytes.
// Never decides what a command does: that is control.hpp's.
#pragma once

#include <deque>
#include <string>
#include <vector>

#include "adapters/pacontrol/twin/control.hpp"
#include "adapters/pacontrol/twin/frame.hpp"
#include "gateway/core/hand_table.hpp"
#include "gateway/core/twin.hpp"

namespace axisgate::pacontrol::twin {

struct DeviceSetup {
    ControlSetup control;
    ReplyCheck reply_check = ReplyCheck::with_etx;
    AnswerFreedoms answers;
    bool fixed_axes = false;  ///< so many axes are built, whatever the site uses
};

class Device final : public Twin {
public:
    /// An acknowledgement may wait so long for the end of processing (E-17).
    static constexpr Duration patience = std::chrono::milliseconds(10);
    /// Acknowledgements that wait for their time; more are lost, which a master that waits for each never sees.
    static constexpr std::size_t waiting_limit = 16;

    explicit Device(const DeviceSetup& setup) : setup_(setup), control_(setup.control), reader_(setup.answers.frames) {}

    void on_frame(const Frame& frame, Instant now, Out& out) override;
    void on_deadline(Instant now, Out& out) override;
    [[nodiscard]] Instant deadline() const override;
    void power_on(const NonVolatile& memory, Instant now, Out& out) override;
    [[nodiscard]] NonVolatile non_volatile() const override { return control_.memory(); }
    [[nodiscard]] bool fit_axes(int axes, Instant now) override;
    [[nodiscard]] std::uint64_t non_volatile_revision() const override { return control_.revision(); }
    [[nodiscard]] std::vector<HandItem> hand() const override;
    [[nodiscard]] std::string set_hand(const std::string& name, const Value& value, Instant now, Out& out) override;
    [[nodiscard]] TwinMechanics mechanics(int channel, Instant now) const override;

    /// For tests and for an image on the same control.
    [[nodiscard]] Control& control() noexcept { return control_; }

private:
    struct Waiting {
        Instant at;
        bool refresh;  ///< the acknowledgement is what the command's state is then
        CommandReply reply;
    };
    void received(const Received& h, Instant now, Out& out);
    /// `earliest`: not before then.
    void answer(const CommandReply& reply, Instant now, Out& out, Instant earliest = Instant::min());
    /// What it says at power on without being asked.
    void announce_power(Instant now, Out& out) const;
    /// Another error number is shown: it says so, if it is one that does.
    void announce_error(Instant now, Out& out);
    void send(const CommandReply& reply, Instant now, Out& out) const;
    void pass(Instant now, Out& out);
    /// What a condition of an axis is set at.
    struct AxisHand {
        Device& device;
        Axis& axis;
        int n;
        template <class Then>
        std::string powered(Then&& then, const HandWish& wish);
    };
    static const HandRow<Device> conditions[];
    static const HandRow<Axis, AxisHand> axis_conditions[];
    [[nodiscard]] std::string set_condition(const std::string& name, const Value& value, Instant now);
    [[nodiscard]] std::string set_axis_condition(int n, const std::string& name, const Value& value, Instant now);

    DeviceSetup setup_;
    Control control_;
    FrameReader reader_;
    std::deque<Waiting> waiting_;
    bool powered_ = false;
    bool silent_ = false;
    Instant deaf_until_ = Instant::min();  ///< it stores a parameter
    std::uint16_t announced_error_ = 0;
    Instant last_ = Instant::min();
};

}  // namespace axisgate::pacontrol::twin
