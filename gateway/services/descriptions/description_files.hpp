// Makers' EDS and DCF files that drives of the site may name: stored, shown, removed, with an event for each change. A file is stored as a
// whole or not at all, never changes, and is not removed while a site needs it.
#pragma once

#include <boost/json/array.hpp>
#include <boost/json/object.hpp>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/services/change_queue.hpp"
#include "gateway/services/ports/clock.hpp"
#include "gateway/services/ports/descriptions.hpp"
#include "gateway/services/ports/events.hpp"
#include "gateway/services/ports/port_set.hpp"
#include "gateway/services/ports/stage.hpp"
#include "gateway/services/refusal.hpp"

namespace axisgate {

/// A value, made where the ports and the queue of the site's changes are available.
class DescriptionFiles {
public:
    using Needs = PortSet<ClockPort, DescriptionPort, EventPort, SitePort, StagePort>;
    DescriptionFiles(const Needs& ports, std::shared_ptr<ChangeQueue> changes) : ports_(ports), changes_(std::move(changes)) {}

    /// Each with its content and the drives that name it, without its PDOs and warnings.
    [[nodiscard]] boost::json::array list() const;
    [[nodiscard]] std::shared_ptr<const Description> find(std::string_view name) const;
    [[nodiscard]] boost::json::object document(const Description& description) const;
    [[nodiscard]] static boost::json::array objects(const Description& description);

    struct Added {
        std::string name;
        boost::json::object document;
        bool is_new = false;  ///< false: an identical file existed
    };
    /// Each `then` is called once, perhaps at once; `thrown` is called if the change threw.
    void add(DescriptionText file, const Origin& origin, std::function<void(Refusable<Added>)> then, ChangeQueue::Failed thrown) const;
    void remove(const std::string& name, const Origin& origin, std::function<void(std::optional<ServiceRefusal>)> then,
                ChangeQueue::Failed thrown) const;

private:
    /// Drives that name it: in the site in force, in the staged one, and in the one to which a trial would roll back.
    [[nodiscard]] std::vector<std::string> users_of(std::string_view name) const;
    void note(const Origin& origin, std::string text) const;

    Needs ports_;
    std::shared_ptr<ChangeQueue> changes_;
};

/// The file itself with its name, or {"name": ..., "text": ...}. `named` is a name outside of the body.
[[nodiscard]] DescriptionText read_description(const boost::json::value& body, std::string text, std::string named,
                                               std::vector<Fault>& faults);

}  // namespace axisgate
