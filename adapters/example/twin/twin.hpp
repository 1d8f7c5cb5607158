// Twin of the example drive: its side of the line, a second reading of its one page.
// In: setup, frames, time, the hand. Out: frames. Shares no code with the adapter.
#pragma once

#include <memory>

#include "gateway/core/twin.hpp"

namespace axisgate::example::twin {

[[nodiscard]] std::unique_ptr<Twin> make_twin(const TwinSetup& setup);

}  // namespace axisgate::example::twin
