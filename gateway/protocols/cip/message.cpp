// Message: a service, a path and the data of the service, decoded in place.
#include "gateway/protocols/cip/message.hpp"

namespace axisgate::cip {

std::optional<Request> read_request(View bytes) noexcept {
    Reader r(bytes);
    Request q;
    q.service = r.u8();
    q.path = r.take(2 * std::size_t{r.u8()});
    q.data = r.rest();
    if (r.bad() || (q.service & service::reply_bit) != 0) return std::nullopt;
    return q;
}

Bytes request(std::uint8_t service, View path, View data) {
    Bytes out{service, static_cast<std::uint8_t>(path.size() / 2)};
    put_bytes(out, path);
    put_bytes(out, data);
    return out;
}

void put_response(Bytes& to, std::uint8_t service, const Response& response) {
    const std::uint8_t head[] = {static_cast<std::uint8_t>(service | service::reply_bit), 0, static_cast<std::uint8_t>(response.general),
                                 static_cast<std::uint8_t>(response.extended.size())};
    put_bytes(to, head);
    for (const std::uint16_t word : response.extended)
        put16(to, word);
    put_bytes(to, response.data);
}

Bytes encode(std::uint8_t service, const Response& response) {
    Bytes out;
    put_response(out, service, response);
    return out;
}

std::optional<Answer> read_answer(View bytes) {
    Reader r(bytes);
    Answer a;
    const std::uint8_t service = r.u8();
    r.skip(1);
    a.service = service & 0x7F;
    a.general = static_cast<General>(r.u8());
    const std::size_t words = r.u8();
    for (std::size_t i = 0; i < words && !r.bad(); ++i)
        a.extended.push_back(r.u16());
    if (r.bad() || (service & service::reply_bit) == 0) return std::nullopt;
    a.data.assign(r.rest().begin(), r.rest().end());
    return a;
}

}  // namespace axisgate::cip
