// The clients that command by EtherNet/IP messages, with their sessions and connections; returns the client whose last one has ended. Pure.
// Bounded by the adapter's number of sessions and connections of explicit messages.
#pragma once

#include <string>
#include <vector>

#include "gateway/axis/authority.hpp"
#include "gateway/protocols/cip/values.hpp"

namespace axisgate::enip {

class MessageClients {
public:
    /// This client has commanded by this session or connection. Datagrams carry no commands.
    void commanded(const AuthorityClient& who, const cip::Peer& way);
    /// A session (its connection is 0: everything of it) or one of its connections has ended. Returns the clients that commanded by it and
    /// have no other one; they are forgotten.
    [[nodiscard]] std::vector<AuthorityClient> ended(const cip::Peer& way);
    /// The sessions by which this client has commanded; empty for other clients.
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
