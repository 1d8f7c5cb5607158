// Message: requests to objects and their answers, in the format of the message router (CIP volume 1, 2-4).
#pragma once

#include <optional>
#include <vector>

#include "gateway/protocols/cip/bytes.hpp"
#include "gateway/protocols/cip/path.hpp"
#include "gateway/protocols/cip/status.hpp"

namespace axisgate::cip {

/// `path` and `data` point into the packet.
struct Request {
    std::uint8_t service = 0;
    View path;
    View data;
};
/// Nothing if it is shorter than its length says.
[[nodiscard]] std::optional<Request> read_request(View bytes) noexcept;
[[nodiscard]] Bytes request(std::uint8_t service, View path, View data = {});

struct Response {
    General general = General::success;
    std::vector<std::uint16_t> extended;
    Bytes data;
    bool pending = false;  ///< the value comes later, in front of `data`

    [[nodiscard]] static Response of(General general) { return {general, {}, {}, false}; }
    [[nodiscard]] static Response refused(Extended why) {
        return {General::connection_failure, {static_cast<std::uint16_t>(why)}, {}, false};
    }
    [[nodiscard]] bool good() const noexcept { return general == General::success; }
};
/// Appends the answer.
void put_response(Bytes& to, std::uint8_t service, const Response& response);
[[nodiscard]] Bytes encode(std::uint8_t service, const Response& response);
/// An answer as an originator decodes it; nothing if it is invalid.
struct Answer {
    std::uint8_t service = 0;  ///< without the reply bit
    General general = General::success;
    std::vector<std::uint16_t> extended;
    Bytes data;
};
[[nodiscard]] std::optional<Answer> read_answer(View bytes);

}  // namespace axisgate::cip
