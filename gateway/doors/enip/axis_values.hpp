// The axes behind the EtherNet/IP objects: inputs from the register image, outputs into lanes, parameters through the drive. Everything
// passes the DoorPort. Bounds: `most_asked` parameters outstanding, an answer within `patience`.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "gateway/core/counter.hpp"
#include "gateway/doors/enip/axis_leases.hpp"
#include "gateway/doors/enip/layout.hpp"
#include "gateway/doors/enip/lost_clients.hpp"
#include "gateway/doors/enip/message_clients.hpp"
#include "gateway/doors/enip/output_lane.hpp"
#include "gateway/doors/enip/window.hpp"
#include "gateway/engine/door.hpp"
#include "gateway/registers/register_image.hpp"
#include "gateway/registers/writer.hpp"

namespace axisgate::enip {

class AxisValues final : public cip::Values {
public:
    static constexpr std::size_t most_asked = 1024;
    static constexpr Duration patience = std::chrono::seconds(30), lease_renewal = std::chrono::seconds(5);
    /// The last argument is the word that follows a bad status, the number of the Reason (register 20); 0: none.
    using Answered = std::function<void(cip::Token, cip::General, cip::View, std::uint16_t)>;
    struct Counters {
        Counter commands, set_points, set_points_refused, parameters;
    };

    /// `told` gets the values of parameters; it is not called from inside ask() or set().
    AxisValues(DoorPort& port, registers::RegisterImage& image, std::int64_t lease_s);
    void use_number(DoorNumber number) noexcept {
        number_ = number;
        writer_.use_number(number);
        leases_.use_number(number);
    }
    void use(Answered answered) { answered_ = std::move(answered); }
    /// The layout of the site in force. Connections whose bytes differ there have been closed; the others continue.
    void use(Layout layout);
    [[nodiscard]] const Layout& layout() const noexcept { return layout_; }
    [[nodiscard]] const registers::Languages& languages() const noexcept { return image_.languages(); }

    void on_result(const Result& result);
    /// Called periodically: ends requests that drives have not answered, and renews leases.
    void sweep(Instant now);

    // --- cip::Values
    [[nodiscard]] const cip::Device& device() const override { return layout_.device(); }
    [[nodiscard]] std::optional<cip::AssemblyInfo> assembly(std::uint32_t instance) const override { return layout_.assembly(instance); }
    [[nodiscard]] const std::vector<std::uint32_t>& assemblies() const override { return layout_.assemblies(); }
    [[nodiscard]] std::uint32_t parameters() const override { return layout_.parameters(); }
    [[nodiscard]] std::optional<cip::ParameterInfo> parameter(std::uint32_t instance) const override { return layout_.parameter(instance); }
    void read(std::uint32_t instance, Instant now, cip::Bytes& to) override;
    [[nodiscard]] std::uint64_t revision(std::uint32_t instance) const override;
    [[nodiscard]] cip::General write(std::uint32_t instance, cip::View data, cip::Token token, const cip::Peer& who, Instant now,
                                     bool& later) override;
    void messages_ended(const cip::Peer& way) override;
    [[nodiscard]] bool commands_by(cip::SessionKey session) const override { return clients_.commands_by(session); }
    [[nodiscard]] bool overlap(std::uint32_t a, std::uint32_t b) const override;
    [[nodiscard]] bool held_by_another(std::uint32_t output, const cip::Peer& who, Instant now) const override;
    void opened(std::uint32_t output, const cip::Peer& who, Duration time_out, Instant now) override;
    void consumed(std::uint32_t output, cip::View data, const cip::Peer& who, Instant now) override;
    void idle(std::uint32_t output, const cip::Peer& who, Instant now) override;
    void ended(std::uint32_t output, const cip::Peer& who, cip::End why, Instant now) override;
    [[nodiscard]] cip::General ask(std::uint32_t instance, cip::Token token, const cip::Peer& who, Instant now) override;
    [[nodiscard]] cip::General set(std::uint32_t instance, cip::View value, cip::Token token, const cip::Peer& who, Instant now) override;

    [[nodiscard]] bool has_own_class(std::uint32_t class_id) const override;
    [[nodiscard]] std::optional<OwnAttribute> own_attribute(std::uint32_t class_id, std::uint32_t instance,
                                                            std::uint32_t attribute) const override;
    [[nodiscard]] cip::General get_own(const OwnPlace& place, Instant now, cip::Bytes& to) override;
    [[nodiscard]] cip::General set_own(const OwnPlace& place, cip::View value, cip::Token token, const cip::Peer& who, Instant now,
                                       bool& later) override;

    [[nodiscard]] const Counters& counters() const noexcept { return counters_; }
    /// The clients that command by messages. The owner of an implicit connection is not among them, because its connection is monitored.
    [[nodiscard]] const MessageClients& message_clients() const noexcept { return clients_; }
    /// The gateway itself ends its sessions: no client has gone.
    void forget_message_clients() noexcept { clients_.clear(); }

private:
    struct Owner {
        Origin origin;
        Duration good_for{};
        std::map<AxisId, OutputLane> lanes;
        std::vector<AxisId> axes;              ///< all axes that it commands
        std::vector<AxisId> held;              ///< those of them that no other client may command while it runs
        bool runs = false;                     ///< in run mode
        std::unique_ptr<WindowOutput> window;  ///< of one of the site's own assemblies
    };
    /// A write of an attribute, until all of its commands have been answered.
    struct OwnWrite final : registers::WriteOwner {
        OwnWrite(AxisValues& of, cip::Token t, Origin by) : values(of), token(t), origin(std::move(by)) { values.lost_.begun(origin); }
        ~OwnWrite() override { values.lost_.answered(origin); }
        OwnWrite(const OwnWrite&) = delete;
        OwnWrite& operator=(const OwnWrite&) = delete;
        void on_written(std::uint8_t slot, AxisId axis, registers::Verdict verdict) override;
        AxisValues& values;
        cip::Token token;
        Origin origin;
        std::uint16_t left = 0;
        cip::General general = cip::General::success;  ///< the first bad one
    };
    /// The same for a write of an output of axes.
    struct MessageWrite {
        void note(Reason why);
        /// Returns true for the last answer.
        [[nodiscard]] bool answered(const Result& result);
        std::uint16_t left = 0, extended = 0;
        cip::General general = cip::General::success;
    };
    struct Asked {
        enum class Kind : std::uint8_t { read, write, output };  ///< of a parameter the first two
        Kind kind = Kind::read;
        cip::Token token = 0;  ///< of an output, 0: a connection's
        std::uint32_t instance = 0;
        std::uint32_t output = 0;
        AxisId axis = no_axis;
        Origin origin;
        ProcessData data;
        Instant until{};
    };
    /// For a message: the connection's client if it commands this axis, so that one controller is one client.
    [[nodiscard]] Origin origin_for(AxisId axis, const cip::Peer& who) const;
    /// The same for a commanding message: from here on its client can be lost.
    [[nodiscard]] Origin commander_for(AxisId axis, const cip::Peer& who);
    [[nodiscard]] bool submit(AxisId axis, CommandBody body, Asked asked, Instant now);
    void carry_out(std::uint32_t output, Owner& owner, AxisId axis, OutputLane::Step step, Instant now);
    void lose(std::uint32_t output, LossCause cause);
    /// shown_values(), looked up once per site and window.
    [[nodiscard]] const std::vector<registers::MapValue>& shown_of(const LayoutWindow& window) const;

    DoorPort& port_;
    registers::RegisterImage& image_;
    registers::RegisterWriter writer_;  // of windows and attributes; its events of refusals and registers 20 and 21 are used by all
    AxisLeases leases_;
    LostClients lost_;
    DoorNumber number_ = 0;
    Answered answered_;
    Layout layout_;
    mutable std::map<std::uint16_t, std::vector<registers::MapValue>> shown_;  // by instance
    std::map<std::uint32_t, Owner> owners_;                                    // by output assembly
    std::map<Ticket, Asked> asked_;
    std::map<cip::Token, OwnWrite> own_writes_;          // at most most_asked, including the next one
    std::map<cip::Token, MessageWrite> message_writes_;  // of outputs of axes
    MessageClients clients_;
    std::size_t questions_ = 0;
    std::uint64_t tickets_ = 0;
    Instant renewed_{};
    Counters counters_;
};

/// "192.0.2.7:51123", and without the port.
[[nodiscard]] std::string text_of(cip::Endpoint endpoint);
[[nodiscard]] std::string address_text(std::uint32_t address);
[[nodiscard]] cip::General general_of(Reason reason) noexcept;
/// The client of an output's connection: each output is a client of its own.
[[nodiscard]] Origin origin_of(std::uint32_t output, const cip::Peer& who);

}  // namespace axisgate::enip
