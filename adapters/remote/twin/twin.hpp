// Twin of the remote family: another gateway with one axis, as a mirror line shows them: a second reading of what telegrams mean.
// In: setup, frames, time, the hand. Out: frames. Shares the words of the line with the adapter, and no rule.
#pragma once

#include <memory>

#include "gateway/core/twin.hpp"

namespace axisgate::remote::twin {

[[nodiscard]] std::unique_ptr<Twin> make_twin(const TwinSetup& setup);

}  // namespace axisgate::remote::twin
