// The packets between the tests' originators and the adapter, checked by an independent EtherNet/IP dissector: after the tests there is a
// failure for each packet of the adapter that tshark calls malformed or warns of. Packets of a test may be wrong on purpose. Needs tshark.
#pragma once

#include <cstdint>

#include "gateway/protocols/cip/adapter.hpp"

namespace axisgate::cip::bench {

class Witness {
public:
    enum class Port : std::uint8_t { stream, datagram, implicit };
    Witness();
    void to_device(Port port, std::uint64_t session, Endpoint from, View bytes) { note(port, session, from, bytes, true); }
    void of_device(Port port, std::uint64_t session, Endpoint to, View bytes) { note(port, session, to, bytes, false); }

private:
    void note(Port port, std::uint64_t session, Endpoint other, View bytes, bool to_device);
    std::uint32_t number_;  // of this device: each has addresses of its own
};

}  // namespace axisgate::cip::bench
