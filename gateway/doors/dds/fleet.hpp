// The states of the domain's gateways, and this gateway's commands to axes of others until each has its one result. Command samples are
// repeated until they are answered, with the same source and id, and are valid for one start of the other gateway; a stop is valid for
// every gateway of its name.
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
    static constexpr Duration sent_again = std::chrono::milliseconds(500);  ///< while there is no result
    static constexpr Duration waits_most = std::chrono::minutes(5);         ///< less than the time for which a gateway remembers a command
    static constexpr Duration lost_kept = std::chrono::minutes(10);
    /// The time for which a command waits for an axis, or a gateway, that may exist and has not been seen yet. States are sent twice a
    /// second.
    static constexpr Duration heard_within = std::chrono::milliseconds(lease_ms);

    /// `send` writes a command to the bus. `name` and `instance` are those of this gateway.
    Fleet(std::string name, std::uint64_t instance, std::function<void(const axisgate_AxisCommand&)> send)
        : name_(std::move(name)), instance_(instance), send_(std::move(send)) {}

    /// A state, or its end. Returns an event if a gateway was discovered or lost.
    [[nodiscard]] std::optional<Event> on_gateway(const axisgate_GatewayState& s, bool alive, std::int64_t now_unix_ns, Instant now);
    void on_axis(const axisgate_AxisState& s, bool valid, bool alive);
    void on_result(const axisgate_CommandResult& s);
    /// Repeats, gives up and forgets; returns the events: a gateway without a message within the lease is lost, whatever the bus reports.
    [[nodiscard]] std::vector<Event> on_turn(Instant now);
    [[nodiscard]] bool alive(std::uint64_t instance) const {
        const auto it = known_.find(instance);
        return it != known_.end() && it->second.gateway.alive;
    }

    /// The present list; the two times are those of this machine's clocks, for ages.
    [[nodiscard]] std::vector<FleetGateway> list(std::int64_t now_unix_ns, Instant now) const;
    /// The gateway of the order, or null with the reason in `fault`.
    [[nodiscard]] const FleetGateway* target(const FleetOrder& order, Result& fault) const;
    /// An axis of another gateway that can be mirrored, or the reason why not (`why`): its gateway does not exist or is lost, the axis is
    /// this gateway's own, its drive is not online, or it is a mirror itself.
    struct Seen {
        const FleetGateway* gateway = nullptr;
        const FleetAxis* axis = nullptr;
        std::string why;
        bool known = false;   ///< it exists, and its drive does not answer
        bool circle = false;  ///< it is this gateway's own or a mirror itself: a command could return here
    };
    /// Increases when a gateway comes or is lost: earlier look-ups may be invalid then.
    [[nodiscard]] std::uint64_t comings() const noexcept { return comings_; }
    [[nodiscard]] Seen mirrored(std::string_view gateway, std::string_view axis) const;
    /// The data were sent before the newest answer to a command from here.
    [[nodiscard]] static bool outdated(const FleetAxis& axis) noexcept { return axis.sequence != 0 && axis.sequence <= axis.answered; }
    [[nodiscard]] static std::int64_t age_ms(const FleetGateway& gateway, const FleetAxis& axis, std::int64_t now_unix_ns);
    /// Gives a command to another gateway. `then` is called once, perhaps from inside this call. A stop (halt, quick_stop) is sent at once,
    /// whatever is known of its gateway and axis, to all gateways of the name except this one, and ends the waiting commands of its axis,
    /// which would otherwise be repeated after it. Its result comes when all live ones have answered or are lost; the worst answer counts.
    /// Up to 2 * waiting_most orders wait; a further stop is sent once, and answered with `busy`. Any other command is for one gateway. If
    /// its axis, or in the first moments the gateway, has not been seen yet, the command waits for it, at most `heard_within` or its own
    /// `wait`.
    void command(const FleetOrder& order, std::function<void(const Result&)> then, Instant now);
    [[nodiscard]] std::size_t waiting() const noexcept { return waiting_.size() + unheard_.size(); }
    /// Another live gateway has this name.
    [[nodiscard]] bool has_other(std::string_view name) const;
    /// Combines the answers of several gateways of one name to a stop: the first one that is not good; an answer that the axis does not
    /// exist does not count if another gateway has it. Needs at least one answer.
    [[nodiscard]] static Result together(const std::vector<Result>& answers, std::string_view gateway);
    /// Number of states of gateways and axes that were ignored because the maximum number was known.
    [[nodiscard]] std::uint64_t left_out() const noexcept { return left_out_; }

private:
    struct Known {
        FleetGateway gateway;
        std::map<std::string, FleetAxis> axes;
        std::size_t axes_told = 0;  // the number of axes that it reports
        Instant lost_at = never, received_at{};
    };
    struct Waiting {
        axisgate_AxisCommand sample{};
        std::array<double, 4> numbers{};  // storage for its optional members
        std::array<std::int32_t, 2> whole{};
        std::set<std::uint64_t> awaited;          // gateways whose answer is outstanding
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
    /// The reason why the order must wait for an axis or gateway that may appear; empty: it can be given now, or never.
    [[nodiscard]] std::optional<std::string> not_heard_yet(const FleetOrder& order, Instant now) const;
    void send(const FleetOrder& order, std::set<std::uint64_t> instances, std::function<void(const Result&)> then, Instant now);
    void stop(const FleetOrder& order, std::function<void(const Result&)> then, Instant now);
    void end_overtaken(const std::string& gateway, const std::string& axis, std::string_view by);
    void try_unheard(Instant now);
    /// Makes a place for one more gateway. Returns false if all known ones are alive and have axes.
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
