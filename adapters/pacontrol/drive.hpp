// Drive: one PA-CONTROL on its serial port, put together from its parts: whose turn it is, and what an acknowledgement is for.
// In: commands, bytes, the passing of time. Out: frames, feedback, samples, results, links, notices.
// Never has two commands on the line, and while end of processing is outstanding sends nothing but polls and the stops that pass.
// Parts: drive_control (what is known), drive_port (one exchange), polls, demand, feedback, drive_jobs (commands on their way), stop, and
// the verbs of drive_verbs.hpp: power, motion, homing, parameters, native, actions.
#pragma once

#include <string>
#include <utility>

#include "adapters/pacontrol/drive_verbs.hpp"

namespace axisgate::pacontrol {

class Drive final : public Control {
public:
    using Control::Control;

    void line_up(Turn& t);
    void line_down(std::string_view why, Turn& t);
    void remove(std::string_view why, Turn& t);
    /// Other axes of the same control: those that stay go on undisturbed.
    void set_axes(const DriveSetup& setup, Turn& t);
    void submit(const Command& command, Turn& t);
    void look(const DriveSetup& setup) noexcept;
    void on_deadline(Turn& t);
    [[nodiscard]] Instant deadline(Instant now) const noexcept;
    /// Sends what is due. Every call from outside ends with it.
    void pump(Turn& t);

    // --- from its port: what became of what was sent ------------------------------------------------------------------------
    void answered(const Sent& sent, const Reply& reply, Turn& t);
    /// The control could not read it (10h, 11h, 12h), so it has not been executed and may be sent again, whatever it was.
    void not_read(const Sent& sent, const Reply& reply, Turn& t);
    void silent(const Sent& sent, Turn& t);
    /// Every answer from here on belongs to what asked for it.
    void in_step();

    Port port{*this};
    Polls polls{*this};
    Demands demands{*this};
    Feedback feedback{*this};
    Jobs jobs{*this};
    Stops stops{*this};
    Power power{*this};
    Moves motion{*this};
    Homing homing{*this};
    Parameters parameters{*this};
    NativeText native{*this};
    Actions actions{*this};

private:
    using Phase = drive::Presence::Phase;

    // drive.cpp
    void take_next(Axis& a, Turn& t);
    [[nodiscard]] std::pair<Job::Kind, Verb*> verb_for(const CommandBody& body) noexcept;
    [[nodiscard]] bool send_renewal(Turn& t);
    void renewed(Axis& a, const Reply& reply, Turn& t);
    void look_answered(const Reply& reply, Turn& t);

    // start.cpp
    void found(Turn& t);
    void count_silence(Turn& t);
    void fail_all(Reason reason, const std::string& text, Turn& t);
    void fail_axis(Axis& a, Reason reason, const std::string& text, Turn& t);
    void forget_all();

    std::uint8_t commands_in_a_row_ = 0;
};

}  // namespace axisgate::pacontrol
