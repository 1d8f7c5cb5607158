// Turn is one call of an adapter: its instant, and the output that is collected during the call. It is not kept beyond the call.
#pragma once

#include "gateway/core/adapter.hpp"

namespace axisgate::drive {

struct Turn {
    Instant now;
    Out& out;
};

}  // namespace axisgate::drive
