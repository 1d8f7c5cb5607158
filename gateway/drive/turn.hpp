// Turn: one call of an adapter from outside, as it is handed down through a family's classes.
// In: the instant of the call. Out: what it gives back, gathered in `out`. Never kept beyond the call.
#pragma once

#include "gateway/core/adapter.hpp"

namespace axisgate::drive {

struct Turn {
    Instant now;
    Out& out;
};

}  // namespace axisgate::drive
