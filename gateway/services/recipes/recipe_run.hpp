// One run of a recipe as a state machine: it gets the time, the values of axes and the answers to its requests, and returns requests, the
// next deadline and the report. It has no clock and no thread, and the same calls give the same results. It never stops a motion that is
// not its own. Bounds: those of the recipe (steps, repeats, seconds); 256 steps per turn; 5 s for stopping axes.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "gateway/services/recipes/recipe.hpp"

namespace axisgate {

/// The values that a run can read without asking a drive.
struct RecipeWorld {
    /// The value of a row of the table of points; unknown if it was never reported, or is too old.
    [[nodiscard]] virtual Value point(std::string_view axis, const AxisPointRow& row) const = 0;

    /// The owner of a motion that this run has started.
    struct Claim {
        enum class Whose : std::uint8_t {
            own,      ///< the run, or unknown
            resting,  ///< the run, and the drive reports that the axis stands
            others    ///< another command or another holder, or a stop has ended it
        };
        Whose whose = Whose::own;
        std::string text;  ///< of `others`: the reason
    };
    [[nodiscard]] virtual Claim claim(std::string_view axis) const { return (void)axis, Claim{}; }
    virtual ~RecipeWorld() = default;
};

struct RecipeRequest {
    enum class What : std::uint8_t {
        step,            ///< carry out `step`
        read_parameter,  ///< read the parameter of step->condition
        stop             ///< stop `axis`, as the recipe says
    };
    std::uint32_t number = 0;  ///< is returned with the answer
    What what = What::step;
    const RecipeStep* step = nullptr;  ///< lives as long as the run
    std::string axis;
};

struct RecipeAnswer {
    /// The effect of the command on the motion of its axis, where `good` does not determine it.
    enum class Motion : std::uint8_t {
        by_result,    ///< good: begun or finished, as the step says; not good: nothing was begun
        nothing,      ///< good, but nothing was begun
        interrupted,  ///< begun, and ended by something else
        unknown       ///< not good, but it may have been begun
    };
    bool good = false;
    std::string text;
    Value value{};  ///< unknown: none
    Motion motion = Motion::by_result;
};

struct RecipeRow {
    enum class State : std::uint8_t { not_run, running, done, failed, cancelled };
    const RecipeStep* step = nullptr;
    State state = State::not_run;
    std::uint32_t times = 0;  ///< number of times that it was begun
    Instant started{}, ended{};
    std::string text;
    std::string pass;  ///< of the surrounding repeats, outer ones first: "2 of 5"; empty: none
    Value value;
};

class RecipeRun {
public:
    enum class State : std::uint8_t { running, stopping, done, failed, cancelled };

    RecipeRun(Recipe recipe, Instant now);
    RecipeRun(const RecipeRun&) = delete;
    RecipeRun& operator=(const RecipeRun&) = delete;

    /// Continues as far as it can now. Every request is answered once through answer(), which must not be called from inside turn().
    void turn(Instant now, const RecipeWorld& world, std::vector<RecipeRequest>& requests);
    /// Answers to requests that are not waited for any more are ignored. The next turn() continues.
    void answer(std::uint32_t number, RecipeAnswer answer);
    /// Ends it early; axes that it has set in motion are stopped in the next turn. Returns false if it has ended already.
    bool cancel(std::string why);

    /// When turn() must be called; `never` after the end.
    [[nodiscard]] Instant deadline() const noexcept { return ended() ? never : due_; }
    [[nodiscard]] State state() const noexcept { return state_; }
    [[nodiscard]] bool ended() const noexcept { return state_ != State::running && state_ != State::stopping; }
    [[nodiscard]] const Recipe& recipe() const noexcept { return recipe_; }
    [[nodiscard]] const std::vector<RecipeRow>& rows() const noexcept { return rows_; }
    [[nodiscard]] const RecipeStep* current() const noexcept { return current_; }
    /// The reason why it failed or was cancelled.
    [[nodiscard]] const std::string& text() const noexcept { return text_; }
    [[nodiscard]] const RecipeStep* where() const noexcept { return where_; }  ///< the step at which it ended early
    [[nodiscard]] Instant started() const noexcept { return started_; }
    [[nodiscard]] Instant ended_at() const noexcept { return ended_at_; }
    struct Stop {
        std::string axis;
        bool answered = false, good = false;
        bool left_alone = false;  ///< no stop was sent, because its motion is not the run's any more
        std::string text;
    };
    [[nodiscard]] const std::vector<Stop>& stops() const noexcept { return stops_; }
    /// Increases with every change of the report.
    [[nodiscard]] std::uint64_t revision() const noexcept { return revision_; }

    static constexpr Duration look_period = std::chrono::milliseconds(20);   ///< of a wait for a point
    static constexpr Duration read_period = std::chrono::milliseconds(200);  ///< of a wait for a parameter: each reading is an exchange
    static constexpr Duration stop_limit = std::chrono::seconds(5);
    /// After an interruption it takes a moment until the drive has accepted the interrupting command; for this time the owner of the motion
    /// is observed.
    static constexpr Duration doubt_limit = std::chrono::seconds(1);
    /// A drive may need this time until it is seen moving; standstill before has no meaning.
    static constexpr Duration start_limit = std::chrono::milliseconds(500);
    static constexpr std::size_t steps_per_turn = 256;

private:
    enum class Phase : std::uint8_t { next, answer, pause, look };
    struct Level {
        const std::vector<RecipeStep>* list;
        std::size_t at = 0;
        const RecipeStep* owner = nullptr;
        std::int64_t rounds = 1;
    };
    /// A motion of the run itself.
    struct Motion {
        Instant begun{};
        bool ends_itself = false;  ///< at a target; a velocity move or an action may continue for ever
        bool interrupted = false;
    };
    bool go_on(Instant now, const RecipeWorld& world, std::vector<RecipeRequest>& requests);
    bool next(Instant now, std::vector<RecipeRequest>& requests);
    void begin(const RecipeStep& step, Instant now, std::vector<RecipeRequest>& requests);
    void ask(RecipeRequest::What what, const RecipeStep& step, Instant now, std::vector<RecipeRequest>& requests);
    void look(const RecipeWorld& world, Instant now, std::vector<RecipeRequest>& requests);
    void judge(const Value& seen, Instant now);
    void take_answer(Instant now);
    void take_motion(const RecipeStep& step, bool good, RecipeAnswer::Motion motion, Instant now);
    void finish(const RecipeStep& step, Instant now);
    void stop(State outcome, std::string text, Instant now);
    [[nodiscard]] bool sort_motions(Instant now, const RecipeWorld& world, std::vector<RecipeRequest>& requests);
    void give_stops(Instant now, const RecipeWorld& world, std::vector<RecipeRequest>& requests);
    void end(Instant now);

    Recipe recipe_;
    std::vector<RecipeRow> rows_;
    std::vector<Level> levels_;
    std::map<std::string, Motion, std::less<>> in_motion_;
    std::set<std::string, std::less<>> prepared_;  ///< prepared, not begun
    std::vector<Stop> stops_;
    std::vector<std::pair<std::uint32_t, std::size_t>> stop_requests_;  // number, index into stops_
    const RecipeStep* current_ = nullptr;
    const RecipeStep* where_ = nullptr;
    State state_ = State::running, outcome_ = State::done;
    Phase phase_ = Phase::next;
    std::uint32_t last_number_ = 0, waiting_for_ = 0;
    std::optional<RecipeAnswer> got_;
    std::optional<std::string> cancelled_;
    std::string text_;
    Instant started_, ended_at_{}, run_limit_, step_limit_{}, doubt_until_{}, due_;
    std::uint64_t revision_ = 1;
};
[[nodiscard]] std::string_view name_of(RecipeRun::State state) noexcept;
[[nodiscard]] std::string_view name_of(RecipeRow::State state) noexcept;

}  // namespace axisgate
