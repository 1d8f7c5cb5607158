// The effect of a native telegram on an axis, determined before it is sent.
#pragma once

#include "gateway/core/catalogue.hpp"
#include "gateway/core/family.hpp"

namespace axisgate::example {

/// Family::stated, by the registers in the README.
[[nodiscard]] Stated stated(const Catalogue& catalogue, int channel, const CommandBody& body);

}  // namespace axisgate::example
