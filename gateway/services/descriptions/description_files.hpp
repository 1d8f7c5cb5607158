// Description files: makers' EDS and DCF files that drives of the site may name: kept, shown, removed.
// In: names, texts, who wants it. Out: what is in a file, who uses it, what is wrong with it and in which line; an event for each change.
// Never takes half of a file, never changes one that is kept, and never removes one that a site rests on.
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

/// A value: whoever has the ports and the queue of the site's changes makes one.
class DescriptionFiles {
public:
    using Needs = PortSet<ClockPort, DescriptionPort, EventPort, SitePort, StagePort>;
    DescriptionFiles(const Needs& ports, std::shared_ptr<ChangeQueue> changes) : ports_(ports), changes_(std::move(changes)) {}

    /// Each with its facts and the drives that name it, without its PDOs and warnings.
    [[nodiscard]] boost::json::array list() const;
    [[nodiscard]] std::shared_ptr<const Description> find(std::string_view name) const;
    [[nodiscard]] boost::json::object document(const Description& description) const;

    struct Added {
        std::string name;
        boost::json::object document;
        bool is_new = false;  ///< else it was there, to the byte
    };
    /// Each `then` is called once, perhaps at once; `thrown`: the change threw.
    void add(DescriptionText file, const Origin& origin, std::function<void(Refusable<Added>)> then, ChangeQueue::Failed thrown) const;
    void remove(const std::string& name, const Origin& origin, std::function<void(std::optional<ServiceRefusal>)> then,
                ChangeQueue::Failed thrown) const;

private:
    /// Drives that name it: in the site in force, in the one that is staged, and in the one that a trial would go back to.
    [[nodiscard]] std::vector<std::string> users_of(std::string_view name) const;
    void note(const Origin& origin, std::string text) const;

    Needs ports_;
    std::shared_ptr<ChangeQueue> changes_;
};

/// The file itself with its name, or {"name": ..., "text": ...}. `named`: by other means than the body.
[[nodiscard]] DescriptionText read_description(const boost::json::value& body, std::string text, std::string named,
                                               std::vector<Fault>& faults);

}  // namespace axisgate
