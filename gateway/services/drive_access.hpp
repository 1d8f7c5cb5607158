// One exchange in a drive's own language, and the tester's conditions of simulated drives. Conditions are never set at a real drive.
#pragma once

#include <boost/json/array.hpp>
#include <boost/json/object.hpp>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "gateway/core/command.hpp"
#include "gateway/services/ports/drives.hpp"
#include "gateway/services/ports/site.hpp"
#include "gateway/services/refusal.hpp"

namespace axisgate {

/// A drive of the site in force.
struct DrivePlace {
    std::shared_ptr<const SiteState> site;
    std::size_t index = 0;
    [[nodiscard]] const DriveSpec& spec() const { return site->site.drives[index]; }
    [[nodiscard]] DriveId id() const { return index < site->drive_ids.size() ? site->drive_ids[index] : no_drive; }
};
[[nodiscard]] std::optional<DrivePlace> find_drive(const SitePort& sites, std::string_view name);

/// The bytes to send, or the faults of the body.
[[nodiscard]] std::optional<Native> read_native(const boost::json::object& body, std::vector<Fault>& faults);
/// An exchange belongs to the drive, but every command names an axis: the axis with the lowest channel represents the drive.
[[nodiscard]] Refusable<std::size_t> axis_for(const DrivePlace& drive);

using HandItems = std::vector<HandItem>;
using HandWish = std::vector<std::pair<std::string, Value>>;
[[nodiscard]] boost::json::object hand_document(const HandItems& items);
[[nodiscard]] boost::json::array hand_description(const HandItems& items);
[[nodiscard]] HandWish read_hand_wish(const boost::json::object& body, std::vector<Fault>& faults);
/// `then` is called once, perhaps at once.
void get_hand(DrivePort& drives, const DrivePlace& drive, std::function<void(Refusable<HandItems>)> then);
void set_hand(DrivePort& drives, const DrivePlace& drive, HandWish wanted, Origin origin, std::function<void(Refusable<HandItems>)> then);

}  // namespace axisgate
