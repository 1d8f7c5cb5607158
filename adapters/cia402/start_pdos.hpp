// PdoSetUp writes the gateway's PDOs into a node, also if the node accepts a mapping in pre-operational only (NMT). If the mapping is
// fixed, the node's own PDOs are read, and those with the values of the axis are used; if the node refuses single entries, it is used
// without them; if that leaves no status word or position, the values of the axis are read by SDO. TPDOs that are not used are switched
// off. While an axis of the node moves, its PDOs are read first and left as they are if they are correct; if the node refuses a change, the
// set-up waits until the axis stands still. A node is never sent to pre-operational while one of its axes moves.
#pragma once

#include <optional>
#include <vector>

#include "adapters/cia402/drive_node.hpp"
#include "adapters/cia402/drive_pdos.hpp"
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
        bool own = false;                        ///< it is the node's own, with a fixed mapping: only its settings are written
    };

    void begin(std::vector<Wanted> wanted);
    [[nodiscard]] bool over() const noexcept { return act_ == Act::over; }
    /// The next read of a moving node; `never`: it does not wait.
    [[nodiscard]] Instant look_at() const noexcept;
    [[nodiscard]] Step next();
    void answered(const canopen::SdoEnd& end, Turn& t);

private:
    enum class Act : std::uint8_t {
        compare,  ///< the PDO of the node is read
        write,
        look,    ///< the node's own PDOs are read
        watch,   ///< the node moves and refuses changes of its PDOs
        unused,  ///< TPDOs that are in use by nobody
        over
    };
    void begin_pdo();
    void next_pdo();
    void accept();
    void compared(const canopen::SdoEnd& end);
    void plan_writes(std::uint32_t id_word);
    void refused(const canopen::SdoEnd& end, Turn& t);
    [[nodiscard]] bool leave_out(const canopen::SdoEnd& end);
    void begin_look();
    void looked(const canopen::SdoEnd& end);
    void use_own();
    void go_without();
    void pre_operational(Turn& t);
    void watched(const canopen::SdoEnd& end, Turn& t);
    void next_unused();
    void unused(const canopen::SdoEnd& end);
    [[nodiscard]] bool moves() const noexcept;

    Act act_ = Act::over;
    std::vector<Wanted> wanted_;
    std::size_t at_ = 0;
    bool careful_ = false;  ///< the node moves: existing PDOs are compared
    bool tried_ = false;    ///< it was sent to pre-operational
    std::optional<canopen::PdoReader> reader_;
    std::vector<canopen::SdoWrite> writes_;
    std::size_t written_ = 0;
    std::size_t axis_ = 0;                              ///< watch: whose values are read
    std::optional<std::vector<canopen::Pdo>> found_{};  ///< the node's own PDOs, when they were read
    std::uint16_t number_ = 1;                          ///< unused: of the TPDO
    std::optional<std::uint32_t> off_{};                ///< unused: identifier word by which it is switched off
};

}  // namespace axisgate::cia402_drive
