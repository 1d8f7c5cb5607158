// Family cia402, what families that stand on it have in common with it: node numbers to be searched, identifiers on the line.
// In: what a scan wants, addresses. Out: plans. Never decides anything about a drive.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "gateway/core/family.hpp"

namespace axisgate {
const Family& family_cia402();
}
namespace axisgate::cia402_drive {

[[nodiscard]] ScanPlan scan_nodes(const ScanWish& wish);
/// The lower seven bits of what a node sends and is sent are its number. NMT and SYNC are nobody's: other CANopen families send them, too.
[[nodiscard]] std::vector<CanIdentifiers> identifiers(std::span<const std::string> addresses);
/// Family::stated, by the numbers of the objects: an object of another axis of the node names that axis' channel.
[[nodiscard]] Stated stated(const Catalogue& catalogue, int channel, const CommandBody& body);

}  // namespace axisgate::cia402_drive
