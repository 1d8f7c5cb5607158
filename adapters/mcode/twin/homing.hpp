// Homing by switch (HM), encoder index (HI) and index offset (HF), types 1 to 4: seek at VM, brake, creep at VI [L3184-3210].
// In: HM, HI, HF, the mark's edges and crossings, limits. Out: legs of motion.
// Never searches for ever in one direction if a limit is there: LM says what a limit does.
#pragma once

#include "adapters/mcode/twin/course.hpp"

namespace axisgate::mcode::twin {

class Homing {
public:
    Homing(Parts& parts, Course& course) : p_(parts), course_(course) {}

    [[nodiscard]] int start(Word word, std::span<const Number> fields, Instant now);
    [[nodiscard]] Word word() const noexcept { return is_.word; }
    [[nodiscard]] int type() const noexcept { return is_.type; }

    /// The home switch changes.
    void switched(bool active, Instant now);
    /// The index passes.
    void index(Instant now) { mark(true, now); }
    /// When it will: the rotor stands at the next index (HF: at the offset from it) in its direction.
    [[nodiscard]] Instant index_due(Instant now) const noexcept;
    void leg_over(Instant now);

    /// Whether a limit is this homing's to answer, by LM.
    [[nodiscard]] bool answers_limit() const noexcept;
    /// True: the limit turns the seek, or has turned it just now.
    [[nodiscard]] bool turn_back(bool at_once, Instant now);
    /// A limit has turned the seek once.
    [[nodiscard]] bool reversed() const noexcept { return is_.reversed; }

private:
    enum class Stage : std::uint8_t {
        seek,  ///< at VM towards the mark
        turn,  ///< braking at the mark, to creep the other way
        back,  ///< braking at a limit, to seek the other way
        creep  ///< at VI until the switch releases, or onto the index
    };
    void seek(int way, Instant now);
    void creep(Instant now);
    void mark(bool active, Instant now);
    void homed(Instant now);

    Parts& p_;
    Course& course_;
    struct {
        Word word = Word::HM;
        Stage stage = Stage::seek;
        int type = 1;  ///< 1..4
        int way = 0;   ///< of the seek
        int creep_way = 0;
        bool reversed = false;
        bool seen = false;  ///< the switch was active in this creep
    } is_;
};

}  // namespace axisgate::mcode::twin
