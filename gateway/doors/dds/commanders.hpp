// Commanders: which client of the domain commanded an axis last, and by which of its writers, so that one whose writers are gone is missed.
// In: commands as they are read, writers that are gone. Out: clients that are lost. Kept by axis: who makes up a new name for each command
// takes no more room by that. Never asks the bus.
#pragma once

#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "gateway/doors/dds/bus.hpp"

namespace axisgate::dds {

class Commanders {
public:
    /// `source` commands the axis now. True: not by this writer before, as far as is known.
    bool note(const std::string& axis, const std::string& source, const Bus::Writer& writer);
    /// The clients that have no writer left of those by which they commanded an axis last.
    [[nodiscard]] std::set<std::string> gone(const Bus::Writer& writer);
    /// All writers that are known, each once.
    [[nodiscard]] std::vector<Bus::Writer> writers() const;
    /// An axis that is no more has no commander.
    void keep(const std::function<bool(const std::string& axis)>& is_there) {
        std::erase_if(commanders_, [&is_there](const auto& c) { return !is_there(c.first); });
    }

private:
    struct Commander {
        std::string source;
        std::vector<Bus::Writer> writers;  // one of commands, one of parameter writes
    };
    std::map<std::string, Commander> commanders_;  // by axis
};

}  // namespace axisgate::dds
