// The twin of the remote family: another gateway with one axis on a mirror line. It shares the wire format with the adapter, and no rules:
// it is a second reading of the meaning of telegrams.
#pragma once

#include <memory>

#include "gateway/core/twin.hpp"

namespace axisgate::remote::twin {

[[nodiscard]] std::unique_ptr<Twin> make_twin(const TwinSetup& setup);

}  // namespace axisgate::remote::twin
