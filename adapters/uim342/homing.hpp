// Homing: the search for a switch (CiA 402 methods 17 to 22), built from the drive's own input actions.
// In: the method, the options home_input, home_active, home_velocity, the level of the input, the standing still of the axis.
// Out: TG[i]=60001 (one time) and IL[i] with "stop" or "origin, then stop", JV and BG; in the end the settings of before.
// The drive itself sets the origin within 1 ms of the edge; nothing here is on the way between the switch and the zero.
// Never writes to EEPROM: every SET is done with the driver on [L1632, L1667], and what was changed is put back.
#pragma once

#include <string>

#include "adapters/uim342/drive_job.hpp"

namespace axisgate::uim342 {

class Homing final : public Verb {
public:
    using Verb::Verb;
    [[nodiscard]] static bool searches(int method) noexcept { return method >= 17 && method <= 22; }

    void plan(const Command& command, Turn& t) override;
    void answered(const Step& step, const Message* m, Turn& t) override;
    void done(Turn& t) override;
    void failed(const Step& step, Failure how, Turn& t) override;

    [[nodiscard]] bool searching() const noexcept { return search_.stage != Stage::idle; }
    /// The axis moves; other values may be read meanwhile.
    [[nodiscard]] bool under_way() const noexcept { return search_.running; }
    void on_status(Turn& t);
    /// The axis stands: what the input has done is to be read.
    [[nodiscard]] bool check_due() const noexcept { return search_.check_due; }
    void check(Turn& t);
    [[nodiscard]] Instant deadline() const noexcept { return search_.give_up; }
    void on_deadline(Turn& t);
    void over(bool good, Reason reason, std::string text, Turn& t);

    [[nodiscard]] bool put_back_due() const noexcept;
    void put_back(Turn& t);
    void nothing_to_put_back() noexcept { changed_ = {}; }

private:
    enum class Stage : std::uint8_t { idle, save, approach, final };
    struct Search {
        Stage stage = Stage::idle;
        Command command;         ///< the Home that asked for it; its ticket is answered by `over`
        bool running = false;    ///< the axis moves
        bool check_due = false;  ///< it stands; IL[i] is to be read to see whether the input has done its work ...
        bool checking = false;   ///< ... and is being read
        int direction = 0;       ///< of the final move
        bool entering = false;   ///< the final edge is that of the switch becoming active
        Instant give_up = never;
    };
    /// What was changed in RAM, as it stood before.
    struct Changed {
        bool pending = false;    ///< to be put back
        std::uint8_t input = 0;  ///< 0..2
        std::uint16_t il = 0, tg = 0;
        std::uint32_t dc_rising = 0, dc_falling = 0;
    };
    void next(Turn& t);
    void begun(Turn& t);
    void arm(Turn& t);
    [[nodiscard]] bool switch_active() const noexcept;

    Search search_;
    Changed changed_;
};

}  // namespace axisgate::uim342
