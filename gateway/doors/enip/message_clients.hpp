// Message clients: who commands by EtherNet/IP messages, and by which sessions and connections.
// In: each command with the way by which it came, each end of a way. Out: the client whose last way has ended. Pure.
// Bounds: a way is a session or a connection of explicit messages, of which the adapter has at most so many.
#pragma once

#include <string>
#include <vector>

#include "gateway/axis/authority.hpp"
#include "gateway/protocols/cip/values.hpp"

namespace axisgate::enip {

class MessageClients {
public:
    /// This client has commanded by this way. A datagram is no way: it carries no commands.
    void commanded(const AuthorityClient& who, const cip::Peer& way);
    /// A session (its connection is 0: all that came by it) or one of its connections has ended. Those who commanded by it and have no
    /// other way left; they are forgotten.
    [[nodiscard]] std::vector<AuthorityClient> ended(const cip::Peer& way);
    /// The sessions by which this client has commanded; none: it is none of these.
    [[nodiscard]] std::vector<cip::SessionKey> sessions_of(const AuthorityClient& who) const;
    [[nodiscard]] bool knows(const AuthorityClient& who) const noexcept;
    [[nodiscard]] bool commands_by(cip::SessionKey session) const noexcept;
    void clear() noexcept { ways_.clear(); }

private:
    struct Way {
        AuthorityClient who;
        cip::SessionKey session = 0;
        std::uint32_t connection = 0;
    };
    std::vector<Way> ways_;
};

}  // namespace axisgate::enip
