// Lost clients: tells that a client is gone, and again when what it had sent before has been answered: a controller that says goodbye while
// its last command is on its way to the drive would else leave behind what that command begins.
// In: commands begun and answered, losses. Out: DoorPort::client_lost. Bounded by the commands that are on their way.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <utility>

#include "gateway/engine/door.hpp"

namespace axisgate::enip {

class LostClients {
public:
    /// `back`: it commands again by another way; then nothing is told a second time.
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
