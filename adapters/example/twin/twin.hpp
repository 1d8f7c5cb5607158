// The twin of the example drive. It shares no code with the adapter: it is a second reading of the description.
#pragma once

#include <memory>

#include "gateway/core/twin.hpp"

namespace axisgate::example::twin {

[[nodiscard]] std::unique_ptr<Twin> make_twin(const TwinSetup& setup);

}  // namespace axisgate::example::twin
