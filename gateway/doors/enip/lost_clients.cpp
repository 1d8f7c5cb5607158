// Commands are counted by client; the loss of a client with outstanding ones is kept until their number is zero.
#include "gateway/doors/enip/lost_clients.hpp"

namespace axisgate::enip {

void LostClients::answered(const Origin& by) {
    const auto who = AuthorityClient::of(by);
    const auto count = on_their_way_.find(who.name);
    if (count == on_their_way_.end() || --count->second > 0) return;
    on_their_way_.erase(count);
    const auto leaves = leaving_.find(who.name);
    if (leaves == leaving_.end()) return;
    const LossCause cause = leaves->second;
    leaving_.erase(leaves);
    if (!back_(who)) port_.client_lost(who, cause);
}

void LostClients::lost(const AuthorityClient& who, LossCause cause) {
    port_.client_lost(who, cause);
    if (on_their_way_.contains(who.name)) leaving_.insert_or_assign(who.name, cause);
}

}  // namespace axisgate::enip
