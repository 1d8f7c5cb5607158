// Fleet: what the gateways of the domain tell, and commands of this one to axes of others until each has its one result.
// In: samples, orders, time. Out: a list of gateways; events for those that come and go; command samples, sent again until they are
// answered. Never a second command: what is sent again has the same source and id, and is meant for one start of its gateway; but a stop is
// for every gateway of its name.
#pragma once

#include <array>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "gateway/core/event.hpp"
#include "gateway/core/instant.hpp"
#include "gateway/doors/dds/bus.hpp"
#include "gateway/services/ports/fleet.hpp"

namespace axisgate::dds {

class Fleet {
public:
    static constexpr std::size_t gateways_most = 256, axes_most = 1024, waiting_most = 256;
    static constexpr Duration sent_again = std::chrono::milliseconds(500);  ///< while no result has come
    static constexpr Duration waits_most = std::chrono::minutes(5);         ///< less than a gateway remembers a command
    static constexpr Duration lost_kept = std::chrono::minutes(10);
    /// So long a command waits for an axis, or for a gateway, that may be there and has not been heard of yet. States come twice a second.
    static constexpr Duration heard_within = std::chrono::milliseconds(lease_ms);

    /// `send` puts a command on the bus. `name`, `instance`: of this gateway.
    Fleet(std::string name, std::uint64_t instance, std::function<void(const axisgate_AxisCommand&)> send)
        : name_(std::move(name)), instance_(instance), send_(std::move(send)) {}

    /// A state, or its end. What there is to be told: a gateway has come, or is lost.
    [[nodiscard]] std::optional<Event> on_gateway(const axisgate_GatewayState& s, bool alive, std::int64_t now_unix_ns, Instant now);
    void on_axis(const axisgate_AxisState& s, bool valid, bool alive);
    void on_result(const axisgate_CommandResult& s);
    /// Sends again, gives up, forgets; and what there is to be told: who has not been heard for the lease is lost, whatever the bus says.
    [[nodiscard]] std::vector<Event> on_turn(Instant now);
    [[nodiscard]] bool alive(std::uint64_t instance) const {
        const auto it = known_.find(instance);
        return it != known_.end() && it->second.gateway.alive;
    }

    /// Now, on both of this machine's clocks: for what is told of ages.
    [[nodiscard]] std::vector<FleetGateway> list(std::int64_t now_unix_ns, Instant now) const;
    /// The one that is meant, or why none is (`fault`).
    [[nodiscard]] const FleetGateway* target(const FleetOrder& order, Result& fault) const;
    /// An axis of another gateway that can be mirrored, or why it cannot (`why`): its gateway is not there or gone, it is this gateway's
    /// own, its drive is not online, or it is a mirror itself.
    struct Seen {
        const FleetGateway* gateway = nullptr;
        const FleetAxis* axis = nullptr;
        std::string why;
        bool known = false;   ///< it is there, and its drive does not answer
        bool circle = false;  ///< it is this gateway's own or a mirror itself: a command could come back here
    };
    /// Counts gateways that come and go: what was looked up before may have changed.
    [[nodiscard]] std::uint64_t comings() const noexcept { return comings_; }
    [[nodiscard]] Seen mirrored(std::string_view gateway, std::string_view axis) const;
    /// What is known of it was told before the newest answer to a command from here.
    [[nodiscard]] static bool outdated(const FleetAxis& axis) noexcept { return axis.sequence != 0 && axis.sequence <= axis.answered; }
    [[nodiscard]] static std::int64_t age_ms(const FleetGateway& gateway, const FleetAxis& axis, std::int64_t now_unix_ns);
    /// Gives it to another gateway. `then` is called once, perhaps from inside this call.
    /// A stop (halt, quick_stop) is sent at once, whatever is known of its gateway and axis, to all gateways of the name but this one, and
    /// ends what waits for its axis, which would otherwise be sent again after it. Its result comes when all that are alive have answered
    /// or are gone; the worst of their answers counts. Up to 2 * waiting_most orders wait; a stop beyond that is sent once, and answered
    /// with `busy`.
    /// Anything else is for one gateway. Where its axis, or in the first moments the gateway, has not been heard of yet, it waits for that,
    /// `heard_within` or its own `wait` at most.
    void command(const FleetOrder& order, std::function<void(const Result&)> then, Instant now);
    [[nodiscard]] std::size_t waiting() const noexcept { return waiting_.size() + unheard_.size(); }
    /// Another gateway that is alive has this name.
    [[nodiscard]] bool has_other(std::string_view name) const;
    /// One result of the answers of several gateways of one name to a stop: the first that is not good; one that has no such axis does not
    /// count if another has. At least one answer.
    [[nodiscard]] static Result together(const std::vector<Result>& answers, std::string_view gateway);
    /// States of gateways and axes that came when as many as are kept were known.
    [[nodiscard]] std::uint64_t left_out() const noexcept { return left_out_; }

private:
    struct Known {
        FleetGateway gateway;
        std::map<std::string, FleetAxis> axes;
        std::size_t axes_told = 0;  // how many it says that it has
        Instant lost_at = never, received_at{};
    };
    struct Waiting {
        axisgate_AxisCommand sample{};
        std::array<double, 4> numbers{};  // what its optional members point to
        std::array<std::int32_t, 2> whole{};
        std::set<std::uint64_t> awaited;          // whose answer is to come
        std::map<std::uint64_t, Result> answers;  // of a stop
        bool stops = false, unheard = false;      // `unheard`: a stop to a gateway that was not alive
        std::string gateway;
        Instant sent{}, until{};
        std::function<void(const Result&)> then;
    };
    struct Unheard {
        FleetOrder order;
        Instant until{};
        std::function<void(const Result&)> then;
    };
    /// Why the order can not be given yet, though it may be soon; nothing: now, or never.
    [[nodiscard]] std::optional<std::string> not_heard_yet(const FleetOrder& order, Instant now) const;
    void send(const FleetOrder& order, std::set<std::uint64_t> instances, std::function<void(const Result&)> then, Instant now);
    void stop(const FleetOrder& order, std::function<void(const Result&)> then, Instant now);
    void end_overtaken(const std::string& gateway, const std::string& axis, std::string_view by);
    void try_unheard(Instant now);
    /// A place for one more gateway. False: all that are known are alive and have axes.
    [[nodiscard]] bool make_room(Instant now);
    void end(const std::string& id, const Result& result);
    [[nodiscard]] Event lose(Known& k, Instant now);

    std::string name_;
    std::uint64_t instance_;
    std::function<void(const axisgate_AxisCommand&)> send_;
    std::map<std::uint64_t, Known> known_;                     // by instance
    std::map<std::string, std::unique_ptr<Waiting>> waiting_;  // by id
    std::vector<Unheard> unheard_;
    std::optional<Instant> opened_;  // the first turn
    std::uint64_t next_ = 1, left_out_ = 0, comings_ = 0;
};

}  // namespace axisgate::dds
