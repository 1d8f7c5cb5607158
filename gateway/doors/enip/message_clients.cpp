// A short list with linear search, because few controllers command by messages.
#include "gateway/doors/enip/message_clients.hpp"

#include <algorithm>

namespace axisgate::enip {

void MessageClients::commanded(const AuthorityClient& who, const cip::Peer& way) {
    if (way.session == 0) return;
    const bool known = std::ranges::any_of(
        ways_, [&](const Way& w) { return w.session == way.session && w.connection == way.connection && w.who == who; });
    if (!known) ways_.push_back({who, way.session, way.connection});
}

std::vector<AuthorityClient> MessageClients::ended(const cip::Peer& way) {
    std::vector<AuthorityClient> gone;
    std::erase_if(ways_, [&](const Way& w) {
        if (w.session != way.session || (way.connection != 0 && w.connection != way.connection)) return false;
        if (std::ranges::find(gone, w.who) == gone.end()) gone.push_back(w.who);
        return true;
    });
    std::erase_if(gone, [&](const AuthorityClient& who) { return knows(who); });
    return gone;
}

std::vector<cip::SessionKey> MessageClients::sessions_of(const AuthorityClient& who) const {
    std::vector<cip::SessionKey> list;
    for (const Way& w : ways_) {
        if (w.who == who && std::ranges::find(list, w.session) == list.end()) list.push_back(w.session);
    }
    return list;
}

bool MessageClients::knows(const AuthorityClient& who) const noexcept {
    return std::ranges::any_of(ways_, [&](const Way& w) { return w.who == who; });
}

bool MessageClients::commands_by(cip::SessionKey session) const noexcept {
    return std::ranges::any_of(ways_, [&](const Way& w) { return w.session == session; });
}

}  // namespace axisgate::enip
