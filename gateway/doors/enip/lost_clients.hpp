// Reports that a client is gone, and again when its outstanding commands have been answered: a controller that disconnects while its last
// command is on its way would otherwise leave the motion that this command begins. Bounded by the outstanding commands.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <utility>

#include "gateway/engine/door.hpp"

namespace axisgate::enip {

class LostClients {
public:
    /// `back` says whether the client commands again by another way; then nothing is reported a second time.
    LostClients(DoorPort& port, std::function<bool(const AuthorityClient&)> back) : port_(port), back_(std::move(back)) {}
    void begun(const Origin& by) { ++on_their_way_[AuthorityClient::of(by).name]; }
    void answered(const Origin& by);
    void lost(const AuthorityClient& who, LossCause cause);

private:
    DoorPort& port_;
    std::function<bool(const AuthorityClient&)> back_;
    std::map<std::string, std::size_t> on_their_way_;  // by the client's name
    std::map<std::string, LossCause> leaving_;
};

}  // namespace axisgate::enip
