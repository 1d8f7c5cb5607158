// The decoder of CANopen captures: one sentence per message, with objects by name. PDOs are decoded by the mapping that was written to the
// node within the capture; PDOs whose mapping was not seen are shown as bytes. The direction of a frame may be unknown.
#pragma once

#include <map>

#include "adapters/cia402/wire.hpp"
#include "gateway/core/family.hpp"

namespace axisgate::cia402_drive {

class CanDecoder final : public Decoder {
public:
    explicit CanDecoder(const Catalogue& catalogue) : catalogue_(catalogue) {}
    std::vector<std::string> on_frame(const Frame& frame, std::optional<bool> to_drive) override;
    std::vector<std::string> finish() override { return {}; }

private:
    struct Node {
        std::map<std::uint16_t, std::map<std::uint8_t, std::uint32_t>> maps;  ///< 16xxh, 1Axxh as they were written
        Address asked;
    };
    [[nodiscard]] const Parameter* entry(Address address, int& axis) const;
    [[nodiscard]] std::string name(Address a) const;
    [[nodiscard]] std::string value(Address a, std::span<const std::uint8_t> bytes) const;
    [[nodiscard]] std::string sdo(const Frame& f, std::uint8_t node, bool request);
    [[nodiscard]] std::string pdo(const Frame& f, const canopen::Role& role);
    const Catalogue& catalogue_;
    std::map<std::uint8_t, Node> nodes_;  ///< at most 127
};

}  // namespace axisgate::cia402_drive
