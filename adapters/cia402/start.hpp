// Start finds a node, reads its identity and state, and sets it up for PDOs, monitoring and set-points. A node that the site does not name
// (in a scan) is only read, never written.
#pragma once

#include <string>
#include <vector>

#include "adapters/cia402/drive_node.hpp"
#include "adapters/cia402/drive_steps.hpp"
#include "adapters/cia402/parameters.hpp"
#include "adapters/cia402/start_pdos.hpp"
#include "gateway/drive/part.hpp"
#include "gateway/protocols/canopen/sdo_client.hpp"

namespace axisgate::cia402_drive {
class Axis;
class Drive;

class Start : public drive::Part<Drive> {
public:
    Start(Drive& drive, const Node& node) : Part(drive), pdos_(drive), expected_(expected_identity(node.catalogue())) {}

    void probe(Turn& t);
    void probed(const canopen::SdoEnd& end, Turn& t);
    void begin();       ///< all steps from the beginning
    void begin_axes();  ///< the axes that are new to the node; the others continue
    /// The set-up may be lost: it is repeated when it is due.
    void forget() noexcept { steps_.clear(); }
    void next(Turn& t);
    /// Within which the node expects the heartbeat of this gateway since before the set-up, which may last longer than that; zero: it does
    /// not.
    [[nodiscard]] Duration watched() const noexcept;
    /// "CiA 402 drive, vendor 99h, product 1h, revision 1h".
    [[nodiscard]] std::string title() const;
    /// The set-up is complete except for NMT start.
    [[nodiscard]] bool at_end() const noexcept { return at_ < steps_.size() && steps_[at_].step.kind == Step::Kind::nmt; }
    /// Waits for the node's own cycle, because its PDOs count SYNCs from NMT start on; or for the next read of a moving node.
    [[nodiscard]] bool waits(Instant now) const noexcept;
    [[nodiscard]] Instant wish() const noexcept { return sets_pdos() ? pdos_.look_at() : never; }
    void answered(const canopen::SdoEnd& end, Turn& t);

private:
    struct StartStep {
        Step step;
        Axis* axis = nullptr;  ///< nullptr: of the node
        bool pdos = false;     ///< the steps of PdoSetUp take this place
    };
    [[nodiscard]] bool sets_pdos() const noexcept { return at_ < steps_.size() && steps_[at_].pdos; }
    void add_axes();
    void set_up();
    void set_up_watch();
    void watch_set(const Step& step, const canopen::SdoEnd& end, Turn& t);
    void set_up_limits();
    void limit_set(const Step& step, const Axis& axis, const canopen::SdoEnd& end, Turn& t);
    void identity_read(Address address, const canopen::SdoEnd& end);
    void cannot_be_set_up(const canopen::SdoEnd& end, Turn& t);
    void done(Turn& t);

    PdoSetUp pdos_;
    std::vector<StartStep> steps_;
    std::size_t at_ = 0;
    std::string identity_;
    ExpectedIdentity expected_;  ///< from the description, if the site names one
    Identity reported_;
    std::size_t limits_open_ = 0;  ///< outstanding writes of 607Dh
    std::uint32_t watched_ = 0;    ///< 1016h:01 as it was read, or written since
};

}  // namespace axisgate::cia402_drive
