// Native: what a client's own telegram would do.
// In: registers that are written. Out: what is stated by them. Never sends.
#pragma once

#include "gateway/core/catalogue.hpp"
#include "gateway/core/family.hpp"

namespace axisgate::example {

/// Family::stated, by the registers of the README.
[[nodiscard]] Stated stated(const Catalogue& catalogue, int channel, const CommandBody& body);

}  // namespace axisgate::example
