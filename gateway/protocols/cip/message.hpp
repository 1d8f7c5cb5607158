// Message: requests to objects and their answers, as the message router has them (CIP volume 1, 2-4).
// In: bytes. Out: service, path and data; an answer's bytes. Never looks at what a service means.
#pragma once

#include <optional>
#include <vector>

#include "gateway/protocols/cip/bytes.hpp"
#include "gateway/protocols/cip/path.hpp"
#include "gateway/protocols/cip/status.hpp"

namespace axisgate::cip {

/// `path` and `data` lie in the packet.
struct Request {
    std::uint8_t service = 0;
    View path;
    View data;
};
/// Nothing: shorter than it says.
[[nodiscard]] std::optional<Request> read_request(View bytes) noexcept;
[[nodiscard]] Bytes request(std::uint8_t service, View path, View data = {});

struct Response {
    General general = General::success;
    std::vector<std::uint16_t> extended;
    Bytes data;
    bool pending = false;  ///< its value comes later, in front of `data`

    [[nodiscard]] static Response of(General general) { return {general, {}, {}, false}; }
    [[nodiscard]] static Response refused(Extended why) {
        return {General::connection_failure, {static_cast<std::uint16_t>(why)}, {}, false};
    }
    [[nodiscard]] bool good() const noexcept { return general == General::success; }
};
/// Appends the answer.
void put_response(Bytes& to, std::uint8_t service, const Response& response);
[[nodiscard]] Bytes encode(std::uint8_t service, const Response& response);
/// What an originator sees: an answer taken apart. Nothing: it is none.
struct Answer {
    std::uint8_t service = 0;  ///< without the reply bit
    General general = General::success;
    std::vector<std::uint16_t> extended;
    Bytes data;
};
[[nodiscard]] std::optional<Answer> read_answer(View bytes);

}  // namespace axisgate::cip
