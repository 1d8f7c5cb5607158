// Door: the DDS door: tells the domain this gateway's states and events, takes commands, parameter writes and set-points for its axes.
// In: the ports, samples of the bus, time. Out: states, events, one result per command; commands with the door `dds` as their origin, under
// the same authority as every other door's. Never touches the hot thread, and never carries out a command twice.
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
    std::function<std::string()> page;    ///< where its page is; empty: it has none
    std::uint64_t instance = 0;           ///< another one at each start, never 0
    std::function<void()> want_change{};  ///< on_change() is to be called once, soon after the next change of a picture; empty: nobody does
};

class DdsDoor final : public ServiceDoor, public FleetPort, public EventListener {
public:
    using Needs = PortSet<AxisPort, ClockPort, EventPort, ParameterPort, SitePort, StatusPort>;
    static constexpr Duration turn = std::chrono::milliseconds(20);              ///< a state is told at most once in it
    static constexpr Duration look_again = std::chrono::milliseconds(2);         ///< after a change that was told at once
    static constexpr Duration published_again = std::chrono::milliseconds(500);  ///< a state that does not change
    static constexpr Duration close_within = std::chrono::seconds(2);            ///< longer the end does not wait for the DDS library
    static constexpr std::size_t set_point_clients_most = 1024;                  ///< axes that are streamed to, as far as this door knows

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
    /// After stop() is done: the library has not let go of its interface, which is down. A thread is left that waits for it.
    [[nodiscard]] bool hangs() const noexcept { return closing_ && !*closed_; }
    void on_event(const Event& event) override;
    [[nodiscard]] std::vector<FleetGateway> fleet() const override { return fleet_.list(ports_.get<ClockPort>().now_unix_ns(), clock_()); }
    /// On the service thread: a picture has changed. Told at once, and not only in the next turn; then again two milliseconds later.
    void on_change();
    /// To an axis of this gateway it goes the way of every command here, under the origin that it has; else over the bus.
    void command(FleetOrder order, std::function<void(const Result&)> then) override;

    /// The other end of a mirror line: a connected stream, which is this door's from here on. More than one can be open.
    void take_mirror(int fd);

    struct Counters {
        std::uint64_t commands = 0, repeated = 0, refused = 0, set_points = 0, set_points_wrong = 0, unsent = 0;
    };
    [[nodiscard]] const Counters& counters() const noexcept { return counters_; }
    /// They as Prometheus text.
    [[nodiscard]] std::string metrics() const;

private:
    struct Published {
        std::string name;
        std::uint64_t revision = 0;
        Instant at{};
        bool ever = false;
    };
    struct Asked;  // a command or a parameter write, as far as they are the same

    void on_turn();
    void tell_gateway(Instant now);
    void tell_axes(Instant now);
    void fill(axisgate_AxisState& s, const AxisPlace& place);
    void read();
    void on_gateway(const axisgate_GatewayState& s, const Bus::Seen& seen);
    void on_command(const axisgate_AxisCommand& s, const Bus::Seen& seen);
    void on_parameter_write(const axisgate_ParameterWrite& s, const Bus::Seen& seen);
    /// Who commands the axis now, and the writer that it does so with.
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
    /// Who commands by this name from there, "hall-1 anna (192.0.2.7, press-2, process 4711)"; known by the name alone.
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
    std::set<std::uint64_t> namesakes_;  // instances of other gateways with this one's name
    Commanders commanders_;
    std::map<std::string, std::string> set_points_;     // who streams, by axis
    std::vector<Bus::Writer> gone_before_;              // that wrote and were gone before that was read: their command is let through first
    std::map<std::uint64_t, std::string> whereabouts_;  // by writer; whereabouts_most at most, then they are asked for anew
    EventRows refusals_;
    Counters counters_;
    std::list<MirrorEnd> mirrors_;
    std::uint64_t sequence_ = 0;  // of the state that was told last
    bool open_ = false, closing_ = false;
    /// What the library's threads call; it outlives the door where they do.
    struct Wake {
        void ring();
        std::mutex mutex;
        DdsDoor* door = nullptr;
    };
    std::shared_ptr<Wake> wake_ = std::make_shared<Wake>();
    std::shared_ptr<std::atomic<bool>> closed_ = std::make_shared<std::atomic<bool>>(false);
    std::shared_ptr<Bus> bus_;  // last: its threads end first
};

}  // namespace axisgate::dds
