// PdoSetUp writes the gateway's PDOs into a node, also if the node accepts a mapping in pre-operational only (NMT). While an axis of the
// node moves, its PDOs are read first and left as they are if they are correct; if the node refuses a change, the set-up waits until the
// axis stands still. A node is never sent to pre-operational while one of its axes moves. If the node refuses the PDOs of an axis at all,
// the values of this axis are read by SDO.
#pragma once

#include <optional>
#include <vector>

#include "adapters/cia402/drive_node.hpp"
#include "adapters/cia402/drive_steps.hpp"
#include "gateway/drive/part.hpp"
#include "gateway/protocols/canopen/pdo.hpp"
#include "gateway/protocols/canopen/sdo_client.hpp"

namespace axisgate::cia402_drive {
class Axis;
class Drive;

class PdoSetUp : public drive::Part<Drive> {
public:
    using Part::Part;
    struct Wanted {
        canopen::Pdo pdo;
        Axis* axis;
        std::optional<SetPoint::Mode> target{};  ///< it carries targets: a node that refuses it is used without it
    };

    void begin(std::vector<Wanted> wanted);
    [[nodiscard]] bool over() const noexcept { return at_ >= wanted_.size(); }
    /// The next read of a moving node; `never`: it does not wait.
    [[nodiscard]] Instant look_at() const noexcept;
    [[nodiscard]] Step next();
    void answered(const canopen::SdoEnd& end, Turn& t);

private:
    void begin_pdo();
    void next_pdo();
    void read(const canopen::SdoEnd& end);
    void plan_writes(std::uint32_t id_word);
    void refused(const canopen::SdoEnd& end, Turn& t);
    void go_without();
    void pre_operational(Turn& t);
    void watched(const canopen::SdoEnd& end, Turn& t);
    [[nodiscard]] bool moves() const noexcept;

    std::vector<Wanted> wanted_;
    std::size_t at_ = 0;
    bool careful_ = false;  ///< the node moves: existing PDOs are compared
    bool tried_ = false;    ///< it was sent to pre-operational
    std::optional<canopen::PdoReader> reader_;
    std::vector<canopen::SdoWrite> writes_;
    std::size_t written_ = 0;
    bool writes_now_ = false;
    // the node moves and refuses changes of its PDOs
    bool watches_ = false;
    std::size_t axis_ = 0;
};

}  // namespace axisgate::cia402_drive
