// Homing: the state of HM, HI and HF: seek at VM, brake, creep at VI [L3184-3210].
// In: nothing by itself; the motor keeps it. Out: values.
// Never decides on limits: twin_limits.cpp does.
#pragma once

#include <cstdint>

#include "adapters/mcode/twin/words.hpp"

namespace axisgate::mcode::twin {

struct Homing {
    enum class Stage : std::uint8_t {
        seek,  ///< at VM towards the mark
        turn,  ///< braking at the mark, to creep the other way
        back,  ///< braking at a limit, to seek the other way
        creep  ///< at VI until the switch releases, or onto the index
    };
    Word word = Word::HM;
    Stage stage = Stage::seek;
    int type = 1;  ///< 1..4
    int way = 0;   ///< of the seek
    int creep_way = 0;
    bool reversed = false;  ///< a limit has turned the seek once
    bool seen = false;      ///< the switch was active in this creep
};

}  // namespace axisgate::mcode::twin
