// Drive: one drive, put together from its parts; what is sent next, and what happens to all of them at once.
// In: commands, messages from the drive, the passing of time, a place in the line's window. Out: frames, feedback, samples, results.
// Never asks two things at once (stops excepted), never sends before it was given a place (stops excepted).
#pragma once

#include <string>
#include <string_view>

#include "adapters/uim342/demand.hpp"
#include "adapters/uim342/drive_exchange.hpp"
#include "adapters/uim342/drive_verbs.hpp"
#include "adapters/uim342/homing.hpp"
#include "adapters/uim342/parameters_known.hpp"
#include "adapters/uim342/polls.hpp"
#include "adapters/uim342/start.hpp"
#include "adapters/uim342/stop.hpp"
#include "gateway/drive/drive_base.hpp"

namespace axisgate::uim342 {

class Drive : public drive::DriveBase {
public:
    static constexpr int channels = 1;
    Drive(Bus& bus, const DriveSetup& setup, std::uint8_t address, std::size_t slot);

    // --- from the adapter -----------------------------------------------------------------------------------------------
    void line_up(Turn& t);
    void line_down(std::string_view why, Turn& t);
    /// Ends everything; the drive is about to be destroyed.
    void remove(std::string_view why, Turn& t);
    void submit(const Command& command, Turn& t);
    void look(const DriveSetup& setup) noexcept { polls.look(setup); }
    void on_message(const Message& m, Turn& t);
    void on_deadline(Turn& t);
    /// Of what it waits for: an answer, a stop's acknowledgement, the end of a supervised ramp or search.
    [[nodiscard]] Instant deadline() const noexcept;
    /// When it will want a place without being asked: its next poll or probe.
    [[nodiscard]] Instant wish() const noexcept;
    /// What it would send now if it were given a place.
    [[nodiscard]] drive::Want wants(Instant now) const noexcept;
    /// A place in the window: sends the next thing.
    void go(Turn& t);

    // --- for its parts --------------------------------------------------------------------------------------------------
    void fail_all(Reason reason, const std::string& text, Turn& t);
    /// By a stop, or because it is gone: a search and a share of a joint start end, and what was prepared is forgotten.
    void break_off(Reason reason, const std::string& text, Turn& t);
    /// The points that an answer tells something about.
    void publish(const Message& answer, std::uint8_t mf, Turn& t) const;
    [[nodiscard]] Message get(std::uint8_t cw, std::uint8_t index = 0) const noexcept { return uim342::get(address_, cw, index); }
    [[nodiscard]] Message set(std::uint8_t cw, std::int64_t v, std::uint8_t index = 0) const noexcept {
        return uim342::set(address_, cw, v, index);
    }
    [[nodiscard]] Message act(std::uint8_t cw) const noexcept { return uim342::act(address_, cw); }
    [[nodiscard]] std::uint8_t address() const noexcept { return address_; }

    Bus& bus;
    const DriveOptions options;
    Exchanges exchanges{*this};
    Stops stops{*this};
    Jobs jobs{*this};
    Start start{*this};
    Polls polls{*this};
    Known known{*this};
    Feedback feedback{*this};
    Errors errors{*this};
    AxisDemand demand{*this};
    Power power{*this};
    FaultReset reset{*this};
    Moves moves{*this};
    Together together{*this};
    Origin origin{*this};
    Homing homing{*this};
    Parameters parameters{*this};
    NativeLines native{*this};

private:
    std::uint8_t address_;
};

}  // namespace axisgate::uim342
