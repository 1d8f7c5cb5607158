// DdsDoor publishes this gateway's states and events in the DDS domain, and accepts commands, parameter writes and set-points for its axes.
// Commands have the origin `dds` and the same authority rules as those of other doors; each has one result and is carried out only once.
// The hot thread is not used.
#pragma once

#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "gateway/core/event_rows.hpp"
#include "gateway/doors/dds/bus.hpp"
#include "gateway/doors/dds/commanders.hpp"
#include "gateway/doors/dds/commands_seen.hpp"
#include "gateway/doors/dds/fleet.hpp"
#include "gateway/doors/dds/mirror_end.hpp"
#include "gateway/doors/dds/words.hpp"
#include "gateway/services/axis_place.hpp"
#include "gateway/services/door.hpp"
#include "gateway/services/ports.hpp"

namespace axisgate::dds {

struct DoorSettings {
    BusSettings bus;
    std::string name;                     ///< of this gateway, 1..63 bytes
    std::string version;                  ///< of the program
    std::function<std::string()> page;    ///< URL of its page; empty: none
    std::uint64_t instance = 0;           ///< differs at each start, never 0
    std::function<void()> want_change{};  ///< requests one call of on_change(), after the next change of a picture; empty: not supported
};

class DdsDoor final : public ServiceDoor, public FleetPort, public EventListener {
public:
    using Needs = PortSet<AxisPort, ClockPort, EventPort, ParameterPort, SitePort, StatusPort>;
    static constexpr Duration turn = std::chrono::milliseconds(20);              ///< a state is written at most once per turn
    static constexpr Duration look_again = std::chrono::milliseconds(2);         ///< after a change that was written at once
    static constexpr Duration published_again = std::chrono::milliseconds(500);  ///< repetition of an unchanged state
    static constexpr Duration close_within = std::chrono::seconds(2);            ///< limit for the wait for the DDS library at the end
    static constexpr std::size_t set_point_clients_most = 1024;                  ///< axes with streamed set-points that this door remembers

    DdsDoor(boost::asio::io_context& context, const Needs& ports, std::function<Instant()> clock, DoorSettings settings);
    ~DdsDoor() override;
    DdsDoor(const DdsDoor&) = delete;
    DdsDoor& operator=(const DdsDoor&) = delete;

    [[nodiscard]] std::span<const WayIn> ways_in() const override { return ways_of_clients; }
    [[nodiscard]] std::string_view name() const override { return "dds"; }
    [[nodiscard]] std::string start() override;
    /// NAME@PARTITION:DOMAIN%INTERFACE: "hall-1@plant:0%lo".
    [[nodiscard]] std::string address() const override;
    void stop(std::function<void()> done) override;
    /// After stop(): the library still uses its interface, which is down, and one of its threads remains.
    [[nodiscard]] bool hangs() const noexcept { return closing_ && !*closed_; }
    void on_event(const Event& event) override;
    [[nodiscard]] std::vector<FleetGateway> fleet() const override { return fleet_.list(ports_.get<ClockPort>().now_unix_ns(), clock_()); }
    /// Service thread: a picture has changed. The state is written at once instead of in the next turn; the next one follows after two
    /// milliseconds at the earliest.
    void on_change();
    /// An order for an axis of this gateway is carried out like every local command, with its own origin; others are sent over the bus.
    void command(FleetOrder order, std::function<void(const Result&)> then) override;

    /// The other end of a mirror line: a connected stream socket, which this door then owns. There may be several.
    void take_mirror(int fd);

    struct Counters {
        std::uint64_t commands = 0, repeated = 0, refused = 0, set_points = 0, set_points_wrong = 0, unsent = 0;
    };
    [[nodiscard]] const Counters& counters() const noexcept { return counters_; }
    /// The counters as Prometheus text.
    [[nodiscard]] std::string metrics() const;

private:
    struct Published {
        std::string name;
        std::uint64_t revision = 0;
        Instant at{};
        bool ever = false;
    };
    struct Asked;  // the common part of commands and parameter writes

    void on_turn();
    void tell_gateway(Instant now);
    void tell_axes(Instant now);
    void fill(axisgate_AxisState& s, const AxisPlace& place);
    void read();
    void on_gateway(const axisgate_GatewayState& s, const Bus::Seen& seen);
    void on_command(const axisgate_AxisCommand& s, const Bus::Seen& seen);
    void on_parameter_write(const axisgate_ParameterWrite& s, const Bus::Seen& seen);
    /// Remembers who commands the axis now, and with which writer.
    void note_commander(const Asked& asked, const Bus::Writer& writer);
    void look_for_gone();
    void on_gone(const Bus::Writer& writer);
    void on_set_point(const axisgate_SetPoint& s, const Bus::Seen& seen);
    [[nodiscard]] bool to_be_done(const Asked& asked);
    void carry_out(const Asked& asked, const AxisPlace& place, CommandBody body, bool until_done);
    void close_bus(std::function<void()> done);
    void wait_for_end(Instant limit, std::function<void()> done);
    void command_here(FleetOrder order, std::function<void(const Result&)> then);
    void tell_again(const std::string& axis);
    void tell_mirrors(std::string_view gateway, std::string_view axis);
    void refuse(const Asked& asked, Reason reason, std::string text);
    void answer(const Asked& asked, const Result& result, bool repeated);
    /// The origin of commands by this name and host, "hall-1 anna (192.0.2.7, press-2, process 4711)"; the name alone identifies it.
    [[nodiscard]] Origin origin_of(const std::string& source, const Bus::Writer& writer);
    [[nodiscard]] std::string whereabouts(const Bus::Writer& writer);
    [[nodiscard]] static AuthorityClient client_of(const std::string& source);

    boost::asio::io_context& context_;
    Needs ports_;
    std::function<Instant()> clock_;
    DoorSettings settings_;
    std::atomic<bool> woken_{false};
    boost::asio::steady_timer timer_, look_timer_;
    CommandsSeen seen_;
    Fleet fleet_;
    std::vector<Published> axes_;
    std::shared_ptr<const SiteState> site_;
    Instant gateway_published_{};
    std::set<std::uint64_t> namesakes_;  // instances of other gateways with the same name
    Commanders commanders_;
    std::map<std::string, std::string> set_points_;     // sender of set-points, by axis
    std::vector<Bus::Writer> gone_before_;              // writers that have ended before their command was read: it is carried out first
    std::map<std::uint64_t, std::string> whereabouts_;  // by writer; after whereabouts_most entries they are requested again
    EventRows refusals_;
    Counters counters_;
    std::list<MirrorEnd> mirrors_;
    std::uint64_t sequence_ = 0;  // of the last state that was written
    bool open_ = false, closing_ = false;
    /// Called by the library's threads; it outlives the door if they do.
    struct Wake {
        void ring();
        std::mutex mutex;
        DdsDoor* door = nullptr;
    };
    std::shared_ptr<Wake> wake_ = std::make_shared<Wake>();
    std::shared_ptr<std::atomic<bool>> closed_ = std::make_shared<std::atomic<bool>>(false);
    std::shared_ptr<Bus> bus_;  // last member, so that its threads end first
};

}  // namespace axisgate::dds
