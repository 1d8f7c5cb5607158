// Drive is one LinMot drive, made of its parts. It chooses the next telegram and passes answers and time-outs to the parts. One request is
// outstanding at a time.
#pragma once

#include <string>
#include <string_view>

#include "adapters/linmot/demand.hpp"
#include "adapters/linmot/drive_exchange.hpp"
#include "adapters/linmot/drive_verbs.hpp"
#include "adapters/linmot/feedback.hpp"
#include "adapters/linmot/motion_stream.hpp"
#include "adapters/linmot/start.hpp"
#include "adapters/linmot/stop.hpp"
#include "gateway/drive/drive_base.hpp"
#include "gateway/drive/polls.hpp"
#include "gateway/drive/turns.hpp"

namespace axisgate::linmot {

class Drive : public drive::DriveBase {
public:
    static constexpr int channels = 1;

    Drive(Bus& bus, const DriveSetup& setup, std::uint8_t id, std::size_t slot);

    // --- from the adapter -----------------------------------------------------------------------------------------------
    void line_up(Turn& t);
    void line_down(std::string_view why, Turn& t);
    void remove(std::string_view why, Turn& t);
    void submit(const Command& command, Turn& t);
    void look(const DriveSetup& setup);
    void follow(const SetPoint& set_point);
    [[nodiscard]] drive::Want wants(Instant now) const noexcept;
    [[nodiscard]] Instant deadline() const noexcept { return exchanges.deadline(); }
    [[nodiscard]] Instant wish() const noexcept;
    void go(Turn& t);
    [[nodiscard]] bool waiting() const noexcept { return exchanges.active(); }
    void on_telegram(const Telegram& telegram, Turn& t);
    void unasked(Turn& t) noexcept { presence.received(t.now); }
    void on_deadline(Turn& t);

    // --- for its parts --------------------------------------------------------------------------------------------------
    /// Forgets everything that depends on the drive's presence. If `why` is given, all waiting commands fail with this reason.
    void lost(Turn& t, std::string why);
    [[nodiscard]] std::uint8_t id() const noexcept { return id_; }
    [[nodiscard]] std::string title() const;

    Bus& bus;
    DriveOptions options;
    Limits limits;
    drive::PollTimer poll;
    drive::Pace pace;
    Exchanges exchanges{*this};
    Start start{*this};
    Stops stops{*this};
    Jobs jobs{*this};
    ControlWord control{*this};
    Feedback feedback{*this};
    AxisDemand demand{*this};
    Power power{*this};
    FaultReset reset{*this};
    MotionOrders motion{*this};
    Moves moves{*this};
    PositionStream stream{*this};
    Homing homing{*this};
    Parameters parameters{*this};
    Transfers transfers{*this};
    NativeTelegram native{*this};
    Actions actions{*this};

private:
    /// The drive was found and has not been lost since.
    [[nodiscard]] bool served() const noexcept {
        return presence.is(drive::Presence::Phase::ready) || presence.is(drive::Presence::Phase::starting);
    }
    void silence(Turn& t);

    std::uint8_t id_;
};

}  // namespace axisgate::linmot
