// The functions that the CANopen families share: the node numbers of a scan, and the CAN identifiers of a node.
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
/// The lower seven bits of a node's identifiers are its number. NMT and SYNC belong to no node, because other CANopen families send them,
/// too.
[[nodiscard]] std::vector<CanIdentifiers> identifiers(std::span<const std::string> addresses);
/// Family::stated by object numbers: an object of another axis of the node stands for the channel of that axis.
[[nodiscard]] Stated stated(const Catalogue& catalogue, int channel, const CommandBody& body);

}  // namespace axisgate::cia402_drive
