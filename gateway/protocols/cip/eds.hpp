// EDS: the electronic data sheet by which engineering tools know the device (CIP volume 1, chapter 7).
// It is written from the description that the objects show. It contains no present values and no date, so it changes with the layout only.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "gateway/protocols/cip/values.hpp"

namespace axisgate::cip {

struct EdsNames {
    std::string vendor, device_type, catalog;
    std::function<std::string(std::uint32_t instance)> assembly, parameter;
};
[[nodiscard]] std::string eds_text(const Description& device, const EdsNames& names);

}  // namespace axisgate::cip
