// Commands is the entry of the engine: it turns a client's command into the orders that carry it out, or into the one reason why it is
// refused. A refused command changes nothing, except that a stop in it is carried out.
#pragma once

#include "gateway/engine/machine.hpp"

namespace axisgate::engine {

class Commands {
public:
    Commands(Machine& machine, Pending& pending, Publisher& publisher, Twins& twins, Orders& orders, Clients& clients, Motions& motions,
             CommandAuthority& authority)
        : machine_(machine),
          pending_(pending),
          publisher_(publisher),
          twins_(twins),
          orders_(orders),
          clients_(clients),
          motions_(motions),
          authority_(authority) {}
    void on_command(Command command, Instant now);

private:
    struct Plan;
    [[nodiscard]] static std::optional<Refusal> turned_away(const Axis& axis, const Command& command, Instant now);
    void answer_hand(const Axis& axis, const Command& command, const Hand& hand, Instant now);
    [[nodiscard]] std::optional<Refusal> plan_for(Axis& axis, Command& command, Plan& plan, Instant now);
    [[nodiscard]] std::optional<Refusal> beyond_reading(const Axis& axis, const CommandBody& body, Plan& plan) const;
    [[nodiscard]] static Refusal behind_a_stop();
    [[nodiscard]] std::optional<Refusal> plan_parameter(const Axis& axis, CommandBody& body, Plan& plan) const;
    [[nodiscard]] std::optional<Refusal> plan_motion(Axis& axis, Command& command, Plan& plan, Instant now);
    [[nodiscard]] std::optional<Refusal> begins_too_early(const Axis& axis, const CommandBody& body) const;
    static void complete(const Axis& axis, Move& move);
    static void note_stop(Axis& axis, const AuthorityClient& by);
    [[nodiscard]] static ProcessData stop_alone(const ProcessData& data);
    void give_the_stop_alone(const Command& command, Instant now);
    [[nodiscard]] static bool needs_authority(const Command& command, const Plan& plan);
    void note_command(const Axis& axis, const Command& command, const Plan& plan, Instant now);
    void carry_out(Axis& axis, Command&& command, Plan&& plan, Instant now);

    Machine& machine_;
    Pending& pending_;
    Publisher& publisher_;
    Twins& twins_;
    Orders& orders_;
    Clients& clients_;
    Motions& motions_;
    CommandAuthority& authority_;
};

}  // namespace axisgate::engine
