// Native: what a client's own command of the control would do.
// In: texts and frames that a person wrote. Out: what is stated by them. Never sends.
#pragma once

#include "gateway/core/catalogue.hpp"
#include "gateway/core/family.hpp"

namespace axisgate::pacontrol {

/// Family::stated. Numbers of axis units are read as increments of 0.001 AE; a command of another axis names its channel.
[[nodiscard]] Stated stated(const Catalogue& catalogue, int channel, const CommandBody& body);

}  // namespace axisgate::pacontrol
