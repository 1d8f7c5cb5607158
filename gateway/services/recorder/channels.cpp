// The names of the channels in a sentence.
#include "gateway/services/recorder/channels.hpp"

#include <fmt/format.h>

namespace axisgate {

std::string listed_points(std::span<const std::string_view> names, std::string_view last) {
    std::string out;
    for (std::size_t i = 0; i < names.size(); ++i)
        out += fmt::format("{}{}", i == 0 ? "" : i + 1 == names.size() ? last : ", ", names[i]);
    return out;
}

}  // namespace axisgate
