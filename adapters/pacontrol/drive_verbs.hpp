// Verbs: CiA 402's and the control's own, each as a list of exchanges with what follows from each answer.
// In: the jobs of axes, acknowledgements. Out: the next request, or the end of the job.
// A verb keeps nothing of its own: where it stands is in the axis' job, so that sixteen axes can use it at once.
#pragma once

#include "adapters/pacontrol/stop.hpp"

namespace axisgate::pacontrol {

inline constexpr Duration renew_period = std::chrono::milliseconds(400);  ///< of a manual move: the control wants it within 1 s [L3606]

/// What every verb works with.
class DriveVerb : public Verb, public Part {
public:
    explicit DriveVerb(Drive& drive) noexcept;

protected:
    ~DriveVerb() = default;
    /// What to do about a command error; empty where its name says it.
    [[nodiscard]] static std::string_view advice_for(std::uint16_t quit);
    Jobs& jobs_;
    Feedback& feedback_;
};

/// power.cpp: enable, reset, and the operating modes.
class Power final : public DriveVerb {
public:
    using DriveVerb::DriveVerb;
    void run(Axis& a, const Reply* reply, Turn& t) override;
    /// The actions online.start, online.stop, online.give_back, automatic.start, automatic.stop, automatic.cancel, by their codes.
    void start_mode(Axis& a, std::uint16_t code, Turn& t);
    void consider_give_back(Turn& t);
    /// 0A97 or 0A98 is refused as unknown or not executable in ONLINE: published once.
    void has_no_switch(Axis& a, std::uint16_t refusal, Turn& t);

private:
    void run_enable(Axis& a, const Reply* reply, Turn& t);
    [[nodiscard]] bool enable_goes_on(Axis& a, const Reply& reply, Turn& t);
    void run_reset(Axis& a, const Reply* reply, Turn& t);
    [[nodiscard]] bool reset_goes_on(Axis& a, const Reply& reply, Turn& t);
    void run_mode(Axis& a, const Reply* reply, Turn& t);
    [[nodiscard]] bool is_there(std::uint16_t code) const noexcept;
};

/// motion.cpp: moves, setting a position, starting several axes.
class Moves final : public DriveVerb {
public:
    using DriveVerb::DriveVerb;
    void run(Axis& a, const Reply* reply, Turn& t) override;

private:
    [[nodiscard]] bool fits(Axis& a, const Move& move, Turn& t);
    void run_move(Axis& a, const Reply* reply, Turn& t);
    [[nodiscard]] bool move_goes_on(Axis& a, const Move& move, const Reply& reply, Turn& t);
    void run_origin(Axis& a, const Reply* reply, Turn& t);
    [[nodiscard]] bool gather(Axis& a, Turn& t);
    void run_together(Axis& a, const Reply* reply, Turn& t);
};

/// homing.cpp: a reference run, and those of several axes one after the other.
class Homing final : public DriveVerb {
public:
    using DriveVerb::DriveVerb;
    void run(Axis& a, const Reply* reply, Turn& t) override;
    /// The action `reference`: "all", channels with commas ("1,3"), or a mask ("0x5"). Each run bars the line until its end.
    void start_several(Axis& a, std::string_view argument, Turn& t);

private:
    void run_home(Axis& a, const Reply* reply, Turn& t);
    void run_several(Axis& a, const Reply& reply, Turn& t);
    enum class Run : std::uint8_t { under_way, ended, failed };
    void watch(Axis& a, const Axis& x, Turn& t);
    [[nodiscard]] Run watched(Axis& a, Axis& x, const Reply& reply, Turn& t);
    void aborted(Axis& a, std::string text, std::int32_t code, Turn& t);
};

/// parameters.cpp: reading and writing points.
class Parameters final : public DriveVerb {
public:
    using DriveVerb::DriveVerb;
    void run(Axis& a, const Reply* reply, Turn& t) override;

private:
    void not_here(Axis& a, const std::string& id, Turn& t);
};

/// native.cpp: exchanges in the control's own language.
class NativeText final : public DriveVerb {
public:
    using DriveVerb::DriveVerb;
    void run(Axis& a, const Reply* reply, Turn& t) override;

private:
    void start(Axis& a, const Native& native, Turn& t);
};

/// actions.cpp: the functions of this family beyond the common ones, by the catalogue's names, and every command code by its own.
class Actions final : public DriveVerb {
public:
    using DriveVerb::DriveVerb;
    void run(Axis& a, const Reply* reply, Turn& t) override;

private:
    void start(Axis& a, const Action& action, Turn& t);
    void start_code(Axis& a, const CommandInfo& info, std::string_view argument, Turn& t);
    void start_until_input(Axis& a, std::string_view argument, Turn& t);
    void start_manual(Axis& a, std::string_view argument, Turn& t);
    void begun(Axis& a, bool conditional, const Reply& reply, Turn& t);
    void learn(Axis& a, const Reply& reply, Turn& t);
};

}  // namespace axisgate::pacontrol
