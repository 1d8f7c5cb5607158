// PdoSetUp: brings the PDOs of the gateway into a node, also into one that maps them in pre-operational alone.
// In: the PDOs that are wanted, answers. Out: reads and writes one after the other, NMT pre-operational for this node where it is needed.
// A node that moves is looked at first: PDOs that are as they should be are not touched, and where the node refuses to have others set as
// it is, it is asked for its state instead until it stands. Never sends a node to pre-operational while an axis of it moves.
#pragma once

#include <optional>
#include <vector>

#include "adapters/cia402/drive_node.hpp"
#include "adapters/cia402/drive_steps.hpp"
#include "gateway/drive/part.hpp"
#include "gateway/protocols/canopen/pdo.hpp"
#include "gateway/protocols/canopen/sdo_client.hpp"

namespace axisgate::cia402_drive {
class Drive;

class PdoSetUp : public drive::Part<Drive> {
public:
    using Part::Part;
    struct Wanted {
        canopen::Pdo pdo;
        bool optional;  ///< a node that refuses it is served without
    };

    void begin(std::vector<Wanted> wanted);
    [[nodiscard]] bool over() const noexcept { return at_ >= wanted_.size(); }
    /// The next look at a node that moves; `never`: it does not wait.
    [[nodiscard]] Instant look_at() const noexcept { return watches_ && seen_ == 0 ? look_at_ : never; }
    [[nodiscard]] Step next();
    /// False: the node cannot be set up.
    [[nodiscard]] bool answered(const canopen::SdoEnd& end, Turn& t);

private:
    void begin_pdo();
    void next_pdo();
    void read(const canopen::SdoEnd& end);
    void plan_writes(std::uint32_t id_word);
    [[nodiscard]] bool refused(const canopen::SdoEnd& end, Turn& t);
    void pre_operational(Turn& t);
    void watched(const canopen::SdoEnd& end, Turn& t);
    [[nodiscard]] bool moves() const noexcept;

    std::vector<Wanted> wanted_;
    std::size_t at_ = 0;
    bool careful_ = false;  ///< it moves: what is there already is compared
    bool tried_ = false;    ///< it was sent to pre-operational
    std::optional<canopen::PdoReader> reader_;
    std::vector<canopen::SdoWrite> writes_;
    std::size_t written_ = 0;
    bool writes_now_ = false;
    // while it moves, and does not let its PDOs be set
    bool watches_ = false;
    Instant look_at_{};
    std::size_t axis_ = 0, seen_ = 0;
    std::vector<std::uint8_t> picture_;
};

}  // namespace axisgate::cia402_drive
