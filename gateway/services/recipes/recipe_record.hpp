// Makes steps of a recipe from the recorded commands of people and panels. Steps of recipes, actions of the gateway itself and refused
// commands are left out. Bounds: 500 steps, 50 sentences about omissions.
#pragma once

#include <boost/json/array.hpp>
#include <boost/json/object.hpp>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "gateway/engine/flight_record.hpp"
#include "gateway/services/axis_place.hpp"

namespace axisgate {

class RecipeRecord {
public:
    static constexpr std::size_t most_left_out = 50;
    static constexpr Duration shortest_pause = std::chrono::milliseconds(100);  ///< a shorter pause is no step
    static constexpr Duration longest_pause = std::chrono::hours(1);            ///< a longer pause is cut
    /// A motion that was never seen moving has ended after this time.
    static constexpr Duration unseen_motion = std::chrono::milliseconds(500);

    /// `axes` belong to one site, which is kept alive. Records after `to` only show how earlier motions ended.
    RecipeRecord(std::vector<AxisPlace> axes, Instant from, Instant to);
    void take(const FlightRecord& record);
    /// {"steps": [...], "left_out": [...]}
    [[nodiscard]] boost::json::object document() const;

private:
    /// The wait after a step.
    enum class After : std::uint8_t {
        nothing,  ///< none: the step waits by itself, or acts at once
        motion,   ///< until the axis stands, if it did
        pause     ///< the time that passed
    };
    struct Draft {
        std::string word;
        boost::json::object body;
        std::size_t axis = 0;
        Instant at{};
        Ticket ticket = no_ticket;
        After after = After::nothing;
        bool seen_moving = false;
        std::optional<Instant> stood;       ///< when it came to rest
        std::optional<Instant> held_until;  ///< of a jog: when it is halted unless it is renewed
        std::int64_t held_target = 0;
    };
    [[nodiscard]] std::optional<std::size_t> place_of(AxisId axis) const;
    void command(const Command& c, Instant at);
    void add(std::string word, boost::json::object body, std::size_t axis, const Command& c, Instant at, After after);
    void move(const Move& m, std::size_t axis, const Command& c, Instant at);
    void set_points(const ProcessData& d, std::size_t axis, const Command& c, Instant at);
    void action(const Action& a, std::size_t axis, const Command& c, Instant at);
    void hand(const FlightRecord& r);
    void picture(const FlightRecord& r);
    void leave_out(std::string text);

    std::vector<AxisPlace> axes_;
    Instant from_, to_;
    std::vector<Draft> drafts_;
    std::map<std::pair<std::size_t, std::uint16_t>, std::int64_t> registers_;  ///< contents of the axes' set-point registers
    std::vector<std::string> left_out_;
    bool full_ = false;
};

}  // namespace axisgate
