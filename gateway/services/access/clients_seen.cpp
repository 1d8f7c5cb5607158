// A short list that is searched linearly and sorted on request. It never grows beyond its bound.
#include "gateway/services/access/clients_seen.hpp"

#include <algorithm>

namespace axisgate {

void ClientsSeen::note(std::string_view name, std::int64_t now_unix_ns) {
    const auto it = std::ranges::find(clients_, name, &Client::name);
    if (it != clients_.end()) {
        it->at_unix_ns = now_unix_ns;
        return;
    }
    if (clients_.size() >= most) clients_.erase(std::ranges::min_element(clients_, {}, &Client::at_unix_ns));
    clients_.push_back({std::string(name), now_unix_ns});
}

std::vector<ClientsSeen::Client> ClientsSeen::list(std::int64_t now_unix_ns) const {
    std::vector<Client> out;
    std::ranges::copy_if(clients_, std::back_inserter(out), [&](const Client& c) { return now_unix_ns - c.at_unix_ns <= forget_after_ns; });
    std::ranges::sort(out, std::ranges::greater{}, &Client::at_unix_ns);
    return out;
}

}  // namespace axisgate
