// Adapter of the UIM342: one line, CAN frames (SimpleCAN3.0) or a byte stream (UIMessage), with up to 122 nodes on it.
// In: setup, line state, commands, frames, time. Out: frames; feedback, samples, results, links, notices.
// One instruction per node at a time (stops excepted), a bounded window of them over all nodes; commands before polls.
// Never sends to an ID that the setup does not name, groups and the global ID excepted where every receiver is known.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "adapters/uim342/drive.hpp"
#include "adapters/uim342/wire_uimessage.hpp"
#include "gateway/drive/line_adapter.hpp"

namespace axisgate::uim342 {

/// Empty if `address` is a node ID 5..126, else what is wrong and what would be right.
[[nodiscard]] std::string check_address(std::string_view address);

class LineAdapter final : private Bus, public drive::TurnsAdapter<Drive> {
public:
    LineAdapter(const Catalogue& of_family, LineKind on) : Bus(of_family, on), TurnsAdapter(static_cast<drive::Bus&>(*this)) {}

    void on_command(const Command& command, Instant now, Out& out) override;
    using TurnsAdapter::counters;

private:
    void take(const LineSetup& setup, Turn& t) override;
    void arrived(const Frame& frame, Turn& t) override;
    [[nodiscard]] std::string fault(const DriveSetup& drive, const LineSetup& line) const override;
    [[nodiscard]] std::unique_ptr<Drive> make(const DriveSetup& setup, std::size_t slot, Turn& t) override;
    void leaving(Drive& drive, Turn& t) override;
    void line_changed(Turn& t) override;
    // Bus
    void transmit(const Message& m, Priority priority, Turn& t, Ticket order) override;
    void share_ready(Drive& drive, Turn& t) override;
    void share_done(Drive& drive, Share share, Turn& t) override;
    [[nodiscard]] std::string user_of(std::uint8_t id, const Drive& but) const override;

    void deliver(const Message& m, Turn& t);
    void tell_other_crc(Turn& t);

    // joint orders: actions.cpp
    struct Joint {
        enum class Kind : std::uint8_t { none, start, start_group, stop };
        enum class Stage : std::uint8_t { gathering, running };
        Kind kind = Kind::none;
        Stage stage = Stage::gathering;
        Command command;
        std::uint8_t group = 0;
        std::vector<Drive*> open;  ///< still to be heard of in this stage
        std::vector<Drive*> members;
        Share worst;  ///< first part that did not end well
        bool bad = false;
    };
    void start_together(const Command& command, const StartTogether& what, Turn& t);
    void start_group(const Command& command, const std::string& argument, Turn& t);
    void global_stop(const Command& command, Turn& t);
    void gather(const Command& command, Joint::Kind how, std::vector<Drive*> members, Turn& t);
    void begin_joint(Turn& t);
    void end_joint(Outcome outcome, Reason reason, std::string text, std::int32_t code, Turn& t);
    [[nodiscard]] std::string whom_to_start(std::uint8_t& id) const;

    bool configured_ = false;
    CrcMode crc_ = CrcMode::twelve;
    UiFramer framer_;
    bool try_thirteen_ = false;        ///< auto: the next unproved frame goes out with the other range
    bool other_crc_reported_ = false;  ///< since the line came up
    std::array<Drive*, 128> by_id_{};
    drive::Tickets tickets_;  ///< of joint orders
    Joint joint_;
};

}  // namespace axisgate::uim342
